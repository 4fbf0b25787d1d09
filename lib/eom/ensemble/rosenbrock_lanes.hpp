// SPDX-License-Identifier: MIT
// Steps of the Rosenbrock method for members side by side, bitwise equal to those of implicit/rodas.hpp. In:
// derivatives and Jacobians of many states, the state and step of each lane. Out: trial states, error norms, dense
// output. Allocates in the constructor only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eom/ensemble/lane_rows.hpp"
#include "eom/ensemble/lu_lanes.hpp"
#include "eom/explicit_rk/controller.hpp"
#include "eom/implicit/rodas.hpp"

namespace eom::ensemble {

/// Rhs: as EnsembleRhs, with jacobian(count, stride, t, x, p, dfdx, dfdt, codes): entry (i, j) of df/dx of state s at
/// [(i + m*j)*stride + s], m the number of components that are not quadratures.
template <class Rhs, std::size_t width>
class RosenbrockLanes : public LaneRows<Rhs, explicit_rk::Controller, width> {
  using Rows = LaneRows<Rhs, explicit_rk::Controller, width>;
  using T = implicit::Rodas5p;

 public:
  RosenbrockLanes(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options)
      : Rows(rhs, states, parameters, options,
             (T::stages + 10) * states + 2 * motions(states, options) * motions(states, options) + 1),
        m_(motions(states, options)),
        known_(stride_),
        lu_(m_, stride_, this->take(m_ * m_), this->take(n_)) {
    f0_ = this->take(n_);
    f1_ = this->take(n_);
    u_ = this->take(T::stages * n_);
    dense_ = this->take(3 * n_);
    rates_ = this->take(3 * n_);  // and, before that, the derivative of a stage
    dfdt_ = this->take(n_);
    dfdx_ = this->take(m_ * m_);
    regular_ = this->take(1);
  }

  /// The dense output of the last step of lane l; 0 < (t - t0)/(t1 - t0) < 1.
  void interpolate(std::size_t l, double t, double* x) const {
    const double s = (t - lane_[l].t()) / h_[l];
    const auto of = [&](const double* rows, std::size_t i) { return rows[i * stride_ + l]; };
    for (std::size_t i = 0; i < m_; ++i) x[i] = implicit::Rodas::motion(s, of(x0_, i), of(x1_, i), bend(l, i));
    for (std::size_t i = m_; i < n_; ++i) {
      const double rates[4]{of(f0_, i), of(rates_, i), of(rates_, n_ + i), of(rates_, 2 * n_ + i)};
      x[i] = implicit::Rodas::quadrature(s, of(x0_, i), h_[l], rates);
    }
  }

 protected:
  using Rows::accepted_;
  using Rows::error_;
  using Rows::f0_;
  using Rows::f1_;
  using Rows::failed_;
  using Rows::h_;
  using Rows::lane_;
  using Rows::n_;
  using Rows::options_;
  using Rows::p_;
  using Rows::padded;
  using Rows::stage_;
  using Rows::stage_t_;
  using Rows::stride_;
  using Rows::t_;
  using Rows::x0_;
  using Rows::x1_;

  static constexpr bool adaptive_method = true;
  static constexpr bool end_known = false;
  static constexpr int order = T::order;
  explicit_rk::Controller steps() const { return implicit::Rodas::control(); }

  void begin_slopes(std::size_t first, std::size_t count) {
    for (std::size_t l = first; l < first + count; ++l) known_[l] = 0;
    of_these_lanes_ = false;
    Rows::begin_slopes(first, count);
  }
  void move(std::size_t to, std::size_t from) {
    known_[to] = known_[from];
    of_these_lanes_ = false;
    Rows::move(to, from);
  }
  void accept() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (accepted_[l] == 0) continue;
      known_[l] = 0;
      of_these_lanes_ = false;
    }
    Rows::accept();
  }

  void attempt() {
    jacobians();
    factor();
    for (std::size_t stage = 0; stage < T::stages; ++stage) solve_stage(stage);
    for (std::size_t l = 0; l < padded(); l += width) {
      for (std::size_t i = 0; i < m_; ++i) {
        const std::size_t at = i * stride_ + l;
        this->advance(i, l, sum(T::b.data(), at, T::stages));
        for (std::size_t k = 0; k < 3; ++k) store(dense_ + k * n_ * stride_ + at, sum(T::dense[k], at, T::stages));
      }
    }
    if (m_ < n_) integrate_quadratures();
    errors();
  }

 private:
  static std::size_t motions(std::size_t states, const EnsembleOptions& options) {
    return states - options.quadratures;
  }

  /// After a rejected step df/dx is unchanged and not counted again.
  void jacobians() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (known_[l] == 0) lane_[l].count_matrix();
    }
    if (of_these_lanes_) return;
    for (std::size_t l = 0; l < lane_.size(); ++l) stage_t_[l] = lane_[l].t();
    this->fail_by(this->rhs_.jacobian(lane_.size(), stride_, stage_t_, x0_, p_, dfdx_, dfdt_, this->codes_.data()));
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack off{};
      for (std::size_t k = 0; k < m_ * m_; ++k) {
        const Pack a = load(dfdx_ + k * stride_ + l);
        off += a - a;
      }
      store(regular_ + l, off);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (failed_[l] == 0 && regular_[l] != 0) failed_[l] = code_not_finite;
      known_[l] = failed_[l] == 0;
    }
    of_these_lanes_ = true;
    for (std::size_t l = 0; l < lane_.size(); ++l) of_these_lanes_ = of_these_lanes_ && known_[l] != 0;
  }

  void factor() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (failed_[l] == 0) lane_[l].count_factorisation();
    }
    for (std::size_t l = 0; l < padded(); l += width) {
      for (std::size_t j = 0; j < m_; ++j) {
        for (std::size_t i = 0; i < m_; ++i) {
          const Pack diagonal = i == j ? 1 / (load(h_ + l) * T::gamma) : Pack{};
          store(lu_.entry(i, j) + l, diagonal - load(dfdx_ + (i + m_ * j) * stride_ + l));
        }
      }
      lu_.factor(l, regular_);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (failed_[l] == 0 && regular_[l] == 0) failed_[l] = code_no_convergence;
    }
  }

  [[gnu::always_inline]] Pack sum(const double* weights, std::size_t at, std::size_t stages) const {
    Pack total{};
    for (std::size_t j = 0; j < stages; ++j) total += weights[j] * load(u_ + j * n_ * stride_ + at);
    return total;
  }

  void solve_stage(std::size_t stage) {
    const double* f = f0_;
    if (stage > 0) {
      for (std::size_t l = 0; l < lane_.size(); ++l) stage_t_[l] = lane_[l].t() + T::c[stage] * h_[l];
      for (std::size_t l = 0; l < padded(); l += width) {
        for (std::size_t i = 0; i < n_; ++i) {
          const std::size_t at = i * stride_ + l;
          store(stage_ + at, load(x0_ + at) + (i < m_ ? sum(T::a[stage], at, stage) : Pack{}));
        }
      }
      this->evaluate_all(stage_t_, stage_, rates_);
      f = rates_;
    }
    double* const u = u_ + stage * n_ * stride_;
    for (std::size_t l = 0; l < padded(); l += width) {
      const Pack h = load(h_ + l);
      for (std::size_t i = 0; i < m_; ++i) {
        const std::size_t at = i * stride_ + l;
        store(u + at, load(f + at) + sum(T::C[stage], at, stage) / h + T::d[stage] * h * load(dfdt_ + at));
      }
      lu_.solve(l, u);
    }
  }

  void errors() {
    const Pack zero{};
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack total{};
      for (std::size_t i = 0; i < m_; ++i) {
        const std::size_t at = i * stride_ + l;
        const Pack error = load(u_ + (T::stages - 1) * n_ * stride_ + at),
                   scale = options_.atol + options_.rtol * larger(size_of(load(x0_ + at)), size_of(load(x1_ + at)));
        const Pack part = error == zero ? zero : error / scale;
        total += part * part;
      }
      store(error_ + l, total);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) error_[l] = std::sqrt(error_[l] / static_cast<double>(m_));
  }

  std::array<double, 3> bend(std::size_t l, std::size_t i) const {
    const std::size_t at = i * stride_ + l, next = n_ * stride_;
    return {dense_[at], dense_[next + at], dense_[2 * next + at]};
  }

  void integrate_quadratures() {
    constexpr double node = implicit::Rodas::node;
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = k == 0 ? node : k == 1 ? 1 - node : 1;
      for (std::size_t l = 0; l < lane_.size(); ++l) {
        stage_t_[l] = lane_[l].t() + s * h_[l];
        for (std::size_t i = 0; i < n_; ++i) {
          const std::size_t at = i * stride_ + l;
          stage_[at] = i < m_ ? implicit::Rodas::motion(s, x0_[at], x1_[at], bend(l, i)) : x0_[at];
        }
      }
      this->evaluate_all(stage_t_, stage_, rates_ + k * n_ * stride_);
    }
    for (std::size_t l = 0; l < padded(); l += width) {
      for (std::size_t i = m_; i < n_; ++i) {
        const std::size_t at = i * stride_ + l, next = n_ * stride_;
        const Pack inner = load(rates_ + at) + load(rates_ + next + at);
        this->advance(i, l, load(h_ + l) / 12 * (load(f0_ + at) + 5 * inner + load(rates_ + 2 * next + at)));
      }
    }
  }

  std::size_t m_;
  std::vector<char> known_;      // per lane: df/dx belongs to its current state
  bool of_these_lanes_ = false;  // all of them are stored in their rows
  LuLanes<width> lu_;
  double *u_, *dense_, *rates_, *dfdt_, *dfdx_;  // stages, dense output, derivatives at Lobatto's nodes
  double* regular_;
};

template <class Rhs, bool dense>
requires requires(Rhs& rhs, const double* a, double* b, int* codes) {
  rhs.jacobian(std::size_t{}, std::size_t{}, a, a, a, b, b, codes);
}
struct LanesOf<implicit::Rodas, Rhs, dense> {
  using type = RosenbrockLanes<Rhs, pack_width>;
  static bool supports(const EnsembleOptions&) { return true; }
};

}  // namespace eom::ensemble
