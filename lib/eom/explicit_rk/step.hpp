// SPDX-License-Identifier: MIT
// One step of any explicit Runge-Kutta method. In: a tableau, a right-hand side, the state and its derivative at t0.
// Out: a trial state at t1, its error norm, and the dense output between. Allocates in the constructor only.
// Compensated summation advances the state, so that many small steps do not accumulate rounding errors of the sum x0 +
// h(...).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "eom/explicit_rk/tableau.hpp"
#include "eom/run_types.hpp"

namespace eom::explicit_rk {

template <class T, class F>
class Stepper {
 public:
  /// x: n components; the last `quadratures` are excluded from the error norm.
  Stepper(F& rhs, std::span<const double> x, std::size_t quadratures)
      : rhs_(&rhs), n_(x.size()), n_error_(x.size() - quadratures), work_((columns<T> + 5 + dense_rows) * n_) {
    double* next = work_.data();
    const auto take = [&](std::size_t vectors) { return std::exchange(next, next + vectors * n_); };
    k_ = take(columns<T>);
    x0_ = take(1);
    x1_ = take(1);
    stage_ = take(1);
    carry_ = take(1);
    new_carry_ = take(1);
    corrections_ = take(dense_rows);
    std::copy(x.begin(), x.end(), x0_);
  }

  std::size_t size() const { return n_; }
  double* x0() { return x0_; }
  double* x1() { return x1_; }
  const double* derivative0() const { return k_; }
  const double* derivative1() const { return k_ + T::stages * n_; }
  double* scratch() { return stage_; }
  Statistics statistics() const {
    Statistics counted;
    counted.rhs_evaluations = rhs_evaluations_;
    counted.dense_fallbacks = dense_fallbacks_;
    return counted;
  }

  int evaluate(double t, const double* x, double* dx) const {
    ++rhs_evaluations_;
    return (*rhs_)(t, x, dx);
  }

  int evaluate_start(double t) { return evaluate(t, x0_, k_); }
  /// Replaces evaluate_start if the derivative at x0 is known.
  void start_with_derivative(const double* f) { std::copy_n(f, n_, k_); }
  int evaluate_end() { return evaluate(t1_, x1_, k_ + T::stages * n_); }

  /// Computes the trial state at t1 from (t0, x0) and the derivative there. Returns the first code that is not 0.
  int attempt(double t0, double t1) {
    t0_ = t0;
    t1_ = t1;
    h_ = t1 - t0;
    corrections_ready_ = false;
    const int code = stages_from<1>();
    if (code != 0) return code;
    advance();
    if constexpr (error_uses_end<T>()) return evaluate_end();
    return 0;
  }

  /// Root mean square over the components of the error estimate in units of atol + rtol |x|: 1 is just allowed.
  double error_norm(double rtol, double atol) const {
    if constexpr (T::error.empty()) {
      return 0;
    } else {
      double sum = 0;
      double guard = 0;
      for (std::size_t i = 0; i < n_error_; ++i) {
        const double scale = atol + rtol * std::max(std::abs(x0_[i]), std::abs(x1_[i]));
        sum += square(in_units(error_sum<0>(i), scale));
        if constexpr (T::error.size() == 2) guard += square(in_units(error_sum<1>(i), scale));
      }
      const double count = static_cast<double>(n_error_);
      if constexpr (T::error.size() == 2) {
        const double both = sum + 0.01 * guard;  // HNW I, eq. (II.10.17)
        return both > 0 ? std::abs(h_) * sum / std::sqrt(count * both) : sum;
      }
      return std::abs(h_) * std::sqrt(sum / count);
    }
  }

  /// Estimate of |h lambda| for the fastest motion: the change of the derivative between the last stage and the end,
  /// both at t1, divided by that of the state (HW II, section IV.2). To be called before accept(), for methods whose
  /// last stage is at t1.
  double stiffness() const {
    static_assert(T::c[T::stages - 1] == 1);
    double change = 0, distance = 0;
    for (std::size_t i = 0; i < n_error_; ++i) {
      change += square(derivative1()[i] - k_[(T::stages - 1) * n_ + i]);
      distance += square(x1_[i] - (x0_[i] + h_ * stage_sum<T::stages - 1>(i)));
    }
    return distance > 0 ? std::abs(h_) * std::sqrt(change / distance) : 0;
  }

  /// Makes the end of the accepted step the start of the next. moved: x1 was changed after attempt().
  void accept(bool moved) {
    std::swap(x0_, x1_);
    std::copy_n(k_ + T::stages * n_, n_, k_);
    if (moved)
      std::fill_n(carry_, n_, 0.0);
    else
      std::swap(carry_, new_carry_);
  }

  /// Dense output of the last trial step, before accept(); for StepView.
  static void interpolate(const void* stepper, double t, double* x) {
    static_cast<const Stepper*>(stepper)->interpolate(t, x);
  }

  void interpolate(double t, double* x) const {
    prepare_corrections();
    const double s = (t - t0_) / h_;
    for (std::size_t i = 0; i < n_; ++i) {
      double sum = 0;
      for (std::size_t row = dense_rows; row-- > 0;)
        sum = (row % 2 == 0 ? 1 - s : s) * (corrections_[row * n_ + i] + sum);
      const double d1 = x1_[i] - x0_[i];
      const double d2 = h_ * k_[i] - d1;
      const double d3 = d1 - h_ * derivative1()[i] - d2;
      x[i] = x0_[i] + s * (d1 + (1 - s) * (d2 + s * (d3 + sum)));
    }
  }

 private:
  static constexpr std::size_t dense_rows = T::dense.size();

  static double square(double value) { return value * value; }
  static double in_units(double error, double scale) { return error == 0 ? 0 : error / scale; }

  template <std::size_t Row>
  double stage_sum(std::size_t i) const {
    return weighted_sum<T::a, Row>(k_ + i, n_, std::make_index_sequence<columns<T>>{});
  }
  template <std::size_t Row>
  double error_sum(std::size_t i) const {
    return weighted_sum<T::error, Row>(k_ + i, n_, std::make_index_sequence<T::stages + 1>{});
  }

  /// Evaluates columns Row, Row + 1, ... up to the last one before the end derivative.
  template <std::size_t Row>
  int stages_from() {
    if constexpr (Row < T::stages) {
      const int code = evaluate_column<Row>();
      return code != 0 ? code : stages_from<Row + 1>();
    } else {
      return 0;
    }
  }

  template <std::size_t Row>
  int evaluate_column() const {
    for (std::size_t i = 0; i < n_; ++i) stage_[i] = x0_[i] + h_ * stage_sum<Row>(i);
    return evaluate(t0_ + T::c[Row] * h_, stage_, k_ + Row * n_);
  }

  void advance() {
    for (std::size_t i = 0; i < n_; ++i) {
      const double increment = h_ * stage_sum<T::stages>(i) + carry_[i];
      const double sum = x0_[i] + increment;
      const double taken = sum - x0_[i];  // Knuth's two-sum: the rounding error of x0 + increment
      new_carry_[i] = (x0_[i] - (sum - taken)) + (increment - taken);
      x1_[i] = sum;
    }
  }

  /// Computes the stages and corrections of the dense output at the first call in a step.
  void prepare_corrections() const {
    if (corrections_ready_ || dense_rows == 0) return;
    corrections_ready_ = true;
    if (dense_columns_from<T::stages + 1>() == 0) {
      fill_corrections(std::make_index_sequence<dense_rows>{});
      if (std::all_of(corrections_, corrections_ + dense_rows * n_, [](double value) { return std::isfinite(value); }))
        return;
    }
    ++dense_fallbacks_;
    std::fill_n(corrections_, dense_rows * n_, 0.0);
  }

  template <std::size_t Row>
  int dense_columns_from() const {
    if constexpr (Row < columns<T>) {
      const int code = evaluate_column<Row>();
      return code != 0 ? code : dense_columns_from<Row + 1>();
    } else {
      return 0;
    }
  }

  template <std::size_t... Row>
  void fill_corrections(std::index_sequence<Row...>) const {
    for (std::size_t i = 0; i < n_; ++i)
      ((corrections_[Row * n_ + i] =
            h_ * weighted_sum<T::dense, Row>(k_ + i, n_, std::make_index_sequence<columns<T>>{})),
       ...);
  }

  F* rhs_;
  std::size_t n_;
  std::size_t n_error_;
  std::vector<double> work_;
  double* k_;  // columns<T> derivatives, n apart
  double* x0_;
  double* x1_;
  double* stage_;  // state of the stage being evaluated
  double* carry_;  // remainders of the sum so far, and after the trial step
  double* new_carry_;
  double* corrections_;  // dense_rows vectors
  double t0_ = 0;
  double t1_ = 0;
  double h_ = 0;
  mutable bool corrections_ready_ = false;
  mutable std::size_t rhs_evaluations_ = 0;
  mutable std::size_t dense_fallbacks_ = 0;
};

}  // namespace eom::explicit_rk
