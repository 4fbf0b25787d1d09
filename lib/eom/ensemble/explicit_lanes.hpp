// SPDX-License-Identifier: MIT
// Steps of an explicit Runge-Kutta method for members side by side, bitwise equal to those of explicit_rk/step.hpp. In:
// a tableau, derivatives of many states, the state and step of each lane. Out: trial states, error norms, dense output.
// Allocates in the constructor only.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include "eom/ensemble/lane_rows.hpp"
#include "eom/explicit_rk/controller.hpp"
#include "eom/explicit_rk/tableau.hpp"

namespace eom::ensemble {

/// T: a tableau. Rhs: as EnsembleRhs. dense: whether the dense output of every accepted step is required.
template <class T, class Rhs, bool dense, std::size_t width>
class ExplicitLanes : public LaneRows<Rhs, explicit_rk::Controller, width> {
  using Rows = LaneRows<Rhs, explicit_rk::Controller, width>;

 public:
  ExplicitLanes(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options)
      : Rows(rhs, states, parameters, options, (columns + dense_rows) * states) {
    k_ = this->take(columns * n_);
    corrections_ = this->take(dense_rows * n_);
    f0_ = k_;
    f1_ = k_ + T::stages * n_ * stride_;
  }

  /// The dense output of the last step of lane l; 0 < (t - t0)/(t1 - t0) < 1.
  void interpolate(std::size_t l, double t, double* x) const {
    const double s = (t - lane_[l].t()) / h_[l];
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t at = i * stride_ + l;
      double sum = 0;
      for (std::size_t row = dense_rows; row-- > 0;)
        sum = (row % 2 == 0 ? 1 - s : s) * (corrections_[row * n_ * stride_ + at] + sum);
      const double d1 = x1_[at] - x0_[at];
      const double d2 = h_[l] * k_[at] - d1;
      const double d3 = d1 - h_[l] * f1_[at] - d2;
      x[i] = x0_[at] + s * (d1 + (1 - s) * (d2 + s * (d3 + sum)));
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
  using Rows::n_error_;
  using Rows::options_;
  using Rows::padded;
  using Rows::stage_;
  using Rows::stage_t_;
  using Rows::stride_;
  using Rows::t_;
  using Rows::x0_;
  using Rows::x1_;

  static constexpr bool adaptive_method = !T::error.empty();
  static constexpr bool end_known = explicit_rk::error_uses_end<T>();
  static constexpr int order = T::order;
  explicit_rk::Controller steps() const { return {T::control, T::order}; }

  /// Computes trial states at t1 of all lanes; failed_ receives the first code of each.
  void attempt() {
    stages_from<1>();
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width)
        this->advance(i, l, load(h_ + l) * weighted<T::a, T::stages>(k_ + i * stride_ + l, every_column));
    }
    if constexpr (end_known) this->evaluate_all(t_, x1_, f1_);
    if constexpr (adaptive_method) errors();
  }

  /// Computes the stages and corrections of the dense output of lanes with an accepted step; no corrections if a stage
  /// fails.
  void prepare_accepted() {
    if constexpr (dense_rows > 0) {
      for (std::size_t l = 0; l < lane_.size(); ++l) failed_[l] = accepted_[l] == 0 ? code_not_finite : 0;
      stages_from<T::stages + 1, columns>();
      fill_corrections(std::make_index_sequence<dense_rows>{});
      for (std::size_t l = 0; l < lane_.size(); ++l) {
        if (accepted_[l] == 0) continue;
        bool known = failed_[l] == 0;
        for (std::size_t i = 0; known && i < dense_rows * n_; ++i) known = std::isfinite(corrections_[i * stride_ + l]);
        if (known) continue;
        lane_[l].fall_back();
        for (std::size_t i = 0; i < dense_rows * n_; ++i) corrections_[i * stride_ + l] = 0;
      }
    }
  }

 private:
  static constexpr std::size_t columns = dense ? explicit_rk::columns<T> : T::stages + 1;
  static constexpr std::size_t dense_rows = dense ? T::dense.size() : 0;
  static constexpr std::make_index_sequence<columns> every_column{};

  template <std::size_t Row, std::size_t end = T::stages>
  void stages_from() {
    if constexpr (Row < end) {
      for (std::size_t l = 0; l < lane_.size(); ++l) stage_t_[l] = lane_[l].t() + T::c[Row] * h_[l];
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t l = 0; l < padded(); l += width) {
          const std::size_t at = i * stride_ + l;
          store(stage_ + at, load(x0_ + at) + load(h_ + l) * weighted<T::a, Row>(k_ + at, every_column));
        }
      }
      this->evaluate_all(stage_t_, stage_, k_ + Row * n_ * stride_);
      stages_from<Row + 1, end>();
    }
  }
  template <const auto& Weights, std::size_t Row, std::size_t... J>
  [[gnu::always_inline]] Pack weighted(const double* k, std::index_sequence<J...>) const {
    Pack sum{};
    (
        [&] {
          if constexpr (Weights[Row][J] != 0) sum += Weights[Row][J] * load(k + J * n_ * stride_);
        }(),
        ...);
    return sum;
  }

  /// Stepper::error_norm of all lanes.
  void errors() {
    const double count = static_cast<double>(n_error_);
    const Pack zero{};
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack sum{}, guard{};
      for (std::size_t i = 0; i < n_error_; ++i) {
        const std::size_t at = i * stride_ + l;
        const Pack scale = options_.atol + options_.rtol * larger(size_of(load(x0_ + at)), size_of(load(x1_ + at)));
        const auto square = [&](Pack error) {
          const Pack value = error == zero ? zero : error / scale;
          return value * value;
        };
        sum += square(weighted<T::error, 0>(k_ + at, std::make_index_sequence<T::stages + 1>{}));
        if constexpr (T::error.size() == 2)
          guard += square(weighted<T::error, 1>(k_ + at, std::make_index_sequence<T::stages + 1>{}));
      }
      store(error_ + l, sum);
      if constexpr (T::error.size() == 2) store(stage_t_ + l, sum + 0.01 * guard);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      const double size = std::abs(h_[l]);
      if constexpr (T::error.size() == 2) {
        if (stage_t_[l] > 0) error_[l] = size * error_[l] / std::sqrt(count * stage_t_[l]);
      } else {
        error_[l] = size * std::sqrt(error_[l] / count);
      }
    }
  }

  template <std::size_t... Row>
  void fill_corrections(std::index_sequence<Row...>) {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width) {
        const std::size_t at = i * stride_ + l;
        (store(corrections_ + Row * n_ * stride_ + at, load(h_ + l) * weighted<T::dense, Row>(k_ + at, every_column)),
         ...);
      }
    }
  }

  double *k_, *corrections_;  // stages; rows of the dense output
};

template <explicit_rk::Tableau T, class Rhs, bool dense>
struct LanesOf<T, Rhs, dense> {
  using type = ExplicitLanes<T, Rhs, dense, pack_width>;
  static bool supports(const EnsembleOptions&) { return true; }
};

}  // namespace eom::ensemble
