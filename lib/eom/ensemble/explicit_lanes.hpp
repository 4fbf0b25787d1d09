// SPDX-License-Identifier: MIT
// Steps of an explicit Runge-Kutta method for some members side by side: their numbers in rows of lanes, and what is
// done with them, with the bits that explicit_rk/step.hpp gives each alone. In: a tableau, derivatives of many states,
// where each lane stands and how far it is to go. Out: trial states, error norms, dense output. Allocates in the
// constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/ensemble/lane.hpp"
#include "eom/ensemble/members.hpp"
#include "eom/ensemble/pack.hpp"
#include "eom/explicit_rk/tableau.hpp"

namespace eom::ensemble {

/// T: a tableau. Rhs: as EnsembleRhs. dense: whether the dense output of every accepted step is asked for.
template <class T, class Rhs, bool dense, std::size_t width>
class ExplicitLanes {
 public:
  ExplicitLanes(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options)
      : rhs_(rhs),
        options_(options),
        n_(states),
        n_error_(states - options.quadratures),
        p_count_(parameters),
        lanes_(slots_of(options, width)),
        stride_(lanes_ % 64 == 0 ? lanes_ + 8 : lanes_),  // rows a power of two apart displace one another in the cache
        work_((columns + dense_rows + 6) * n_ * stride_ + p_count_ * stride_ + 8 * stride_ + n_ + p_count_),
        codes_(stride_),
        failed_(stride_) {
    double* at = work_.data();
    const auto take = [&](std::size_t rows) { return std::exchange(at, at + rows * stride_); };
    k_ = take(columns * n_);
    corrections_ = take(dense_rows * n_);
    x0_ = take(n_);
    x1_ = take(n_);
    stage_ = take(n_);
    carry_ = take(n_);
    new_carry_ = take(n_);
    scratch_ = take(n_);
    p_ = take(p_count_);
    t_ = take(1);
    h_ = take(1);
    stage_t_ = take(1);
    error_ = take(1);
    state_ = take(1);
    slope_ = take(1);
    size_ = take(1);
    accepted_ = take(1);
    one_x_ = at;
    one_p_ = at + n_;
    lane_.reserve(lanes_);
  }

  /// The dense output of the step that lane l has just made; 0 < (t - t0)/(t1 - t0) < 1.
  void interpolate(std::size_t l, double t, double* x) const {
    const double s = (t - lane_[l].t()) / h_[l];
    const double* const end = k_ + T::stages * n_ * stride_;
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t at = i * stride_ + l;
      double sum = 0;
      for (std::size_t row = dense_rows; row-- > 0;)
        sum = (row % 2 == 0 ? 1 - s : s) * (corrections_[row * n_ * stride_ + at] + sum);
      const double d1 = x1_[at] - x0_[at];
      const double d2 = h_[l] * k_[at] - d1;
      const double d3 = d1 - h_[l] * end[at] - d2;
      x[i] = x0_[at] + s * (d1 + (1 - s) * (d2 + s * (d3 + sum)));
    }
  }

 protected:
  static constexpr std::size_t columns = dense ? explicit_rk::columns<T> : T::stages + 1;
  static constexpr std::size_t dense_rows = dense ? T::dense.size() : 0;
  static constexpr bool adaptive_method = !T::error.empty();
  static constexpr bool end_known = explicit_rk::error_uses_end<T>();
  std::size_t padded() const { return (lane_.size() + width - 1) / width * width; }
  double* end_slopes() const { return k_ + T::stages * n_ * stride_; }

  /// Derivatives of lanes from `first` on.
  int evaluate(std::size_t first, std::size_t count, const double* t, const double* x, double* dx) {
    for (std::size_t l = first; l < first + count; ++l) lane_[l].count(1);
    return rhs_(count, stride_, t + first, x + first, p_ + first, dx + first, codes_.data() + first);
  }

  void move(std::size_t to, std::size_t from) {
    const auto rows = [&](double* array, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) array[i * stride_ + to] = array[i * stride_ + from];
    };
    rows(k_, n_);
    rows(x0_, n_);
    rows(carry_, n_);
    rows(p_, p_count_);
  }

  /// Trial states at t1 of all lanes; failed_ has the first code of each.
  void attempt() {
    stages_from<1>();
    advance();
    if constexpr (end_known) evaluate_column(t_, x1_, end_slopes());
    if constexpr (adaptive_method) errors();
  }

  /// The stages and corrections of the dense output of lanes whose step was accepted; where one fails, none.
  void prepare_dense() {
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

  /// Of the trial states: 0 where all is finite, else no number; and the largest component.
  void examine(const double* end) {
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack state{}, slope{}, size{};
      for (std::size_t i = 0; i < n_; ++i) {
        const Pack x = load(x1_ + i * stride_ + l), f = load(end + i * stride_ + l);
        state += x - x;
        slope += f - f;
        size = larger(size, size_of(x));
      }
      store(state_ + l, state);
      store(slope_ + l, slope);
      store(size_ + l, size);
    }
  }

  /// Of lanes whose step was accepted the end is the start of the next.
  void accept() {
    const double* const end = end_slopes();
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width) {
        const std::size_t at = i * stride_ + l;
        const Pack zero{}, accepted = load(accepted_ + l);
        store(x0_ + at, accepted == zero ? load(x0_ + at) : load(x1_ + at));
        store(k_ + at, accepted == zero ? load(k_ + at) : load(end + at));
        store(carry_ + at, accepted == zero ? load(carry_ + at) : load(new_carry_ + at));
      }
    }
  }

 private:
  template <std::size_t Row, std::size_t end = T::stages>
  void stages_from() {
    if constexpr (Row < end) {
      for (std::size_t l = 0; l < lane_.size(); ++l) stage_t_[l] = lane_[l].t() + T::c[Row] * h_[l];
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t l = 0; l < padded(); l += width) {
          const std::size_t at = i * stride_ + l;
          store(stage_ + at,
                load(x0_ + at) + load(h_ + l) * weighted<T::a, Row>(k_ + at, std::make_index_sequence<columns>{}));
        }
      }
      evaluate_column(stage_t_, stage_, k_ + Row * n_ * stride_);
      stages_from<Row + 1, end>();
    }
  }
  void evaluate_column(const double* t, const double* x, double* dx) {
    for (std::size_t l = 0; l < lane_.size(); ++l) lane_[l].count(failed_[l] == 0 ? 1 : 0);
    if (rhs_(lane_.size(), stride_, t, x, p_, dx, codes_.data()) == 0) return;
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (failed_[l] == 0) failed_[l] = codes_[l];
    }
  }

  template <const auto& Rows, std::size_t Row, std::size_t... J>
  [[gnu::always_inline]] Pack weighted(const double* k, std::index_sequence<J...>) const {
    Pack sum{};
    (
        [&] {
          if constexpr (Rows[Row][J] != 0) sum += Rows[Row][J] * load(k + J * n_ * stride_);
        }(),
        ...);
    return sum;
  }

  void advance() {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width) {
        const std::size_t at = i * stride_ + l;
        const Pack x = load(x0_ + at);
        const Pack increment =
            load(h_ + l) * weighted<T::a, T::stages>(k_ + at, std::make_index_sequence<columns>{}) + load(carry_ + at);
        const Pack sum = x + increment;
        const Pack taken = sum - x;
        store(new_carry_ + at, (x - (sum - taken)) + (increment - taken));
        store(x1_ + at, sum);
      }
    }
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
        (store(corrections_ + Row * n_ * stride_ + at,
               load(h_ + l) * weighted<T::dense, Row>(k_ + at, std::make_index_sequence<columns>{})),
         ...);
      }
    }
  }

 protected:
  Rhs& rhs_;
  const EnsembleOptions& options_;
  std::size_t n_, n_error_, p_count_, lanes_, stride_;
  std::vector<double> work_;
  std::vector<int> codes_, failed_;
  std::vector<Lane> lane_;
  double *k_, *x0_, *x1_, *stage_, *carry_, *new_carry_, *scratch_, *p_;  // rows of lanes, stride_ apart
  double* corrections_;                                                   // of the dense output
  double *t_, *h_, *stage_t_, *error_;                                    // t_: where the trial step ends
  double *state_, *slope_, *size_, *accepted_;                            // of examine() and the decisions
  double *one_x_, *one_p_;                                                // of one member
};

}  // namespace eom::ensemble
