// SPDX-License-Identifier: MIT
// One step of the variational integrator of order 2, and its exact derivatives. In: functions of a model with momenta
// P = dL/d(qdot) and their rates R, and derivatives of both. Out: x1 = (q1, v1), solved to rounding, and derivatives by
// the implicit function theorem. With d = q1 - q, and P and R of the middle at (t + h/2, q + d/2, d/h):
//   P - h/2 R = P(t, q, v),   p1 = P(t, q, v) + h R,   P(t + h, q1, v1) = p1.
// Source: Marsden, West, Discrete mechanics and variational integrators, Acta Numerica 10 (2001), sections 2.3 and 3.2,
// as eom/variational/integrator.hpp. The state has coordinates and their rates only, and no constraint keeps a
// multiplier. Allocates in the constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "eom/discrete/functions.hpp"
#include "eom/implicit/newton.hpp"
#include "eom/linalg/lu.hpp"
#include "eom/outcome.hpp"

namespace eom::discrete {

class Variational {
 public:
  static constexpr const char* name = "variational2";
  static constexpr int order = 2;

  /// Throws std::invalid_argument if the state is not one of coordinates and rates.
  explicit Variational(const Sizes& sizes)
      : sizes_(sizes),
        n_(sizes.states / 2),
        d_(n_),
        start_(2 * n_),
        middle_(2 * n_),
        end_(2 * n_),
        at_(2 * n_),
        right_(n_),
        of_start_(sizes),
        of_middle_(sizes),
        of_end_(sizes),
        by_d_(n_),
        by_rate_(n_) {
    if (sizes.states != 2 * n_)
      throw std::invalid_argument("eom::discrete::Step: variational2 needs a state of coordinates and rates");
  }

  /// x1: N, may be x. Returns a code of the functions, code_no_function without momenta and momenta_jac, or
  /// code_no_convergence.
  template <class F>
  int step(const F& f, const Arguments& at, double* x1) {
    if (const int code = detail::momenta(f, at, at.t, at.x, start_.data(), n_); code != 0) return code;
    if (const int code = solve_middle(f, at); code != 0) return code;
    if (const int code = solve_end(f, at); code != 0) return code;
    std::copy(at_.begin(), at_.end(), x1);
    return 0;
  }

  /// The same with derivatives.
  template <class F>
  int derivatives(const F& f, const Arguments& at, double* x1, const Derivatives& to) {
    if (const int code = step(f, at, x1); code != 0 || !to.any()) return code;
    const double middle = at.t + 0.5 * at.h, end = at.t + at.h;
    const bool timed = to.t != nullptr || to.h != nullptr;
    if (const int code = of_start_.evaluate(f, at, at.t, at.x, timed, to); code != 0) return code;
    if (const int code = of_end_.evaluate(f, at, end, x1, timed, to); code != 0) return code;
    place_middle(at);
    if (const int code = detail::momenta(f, at, middle, at_.data(), middle_.data(), n_); code != 0) return code;
    if (const int code = of_middle_.evaluate(f, at, middle, at_.data(), timed, to); code != 0) return code;
    if (const int code = factor(at.h); code != 0) return code;
    if (const int code = factor_end(); code != 0) return code;
    for (std::size_t j = 0; to.x != nullptr && j < 2 * n_; ++j) differentiate_state(at.h, j, to.x + 2 * n_ * j);
    for (std::size_t j = 0; to.p != nullptr && j < sizes_.parameters; ++j)
      differentiate(at.h, {of_start_.p(j), of_middle_.p(j), of_end_.p(j)}, to.p + 2 * n_ * j);
    for (std::size_t j = 0; to.u != nullptr && j < sizes_.inputs; ++j)
      differentiate(at.h, {of_start_.u(j), of_middle_.u(j), of_end_.u(j)}, to.u + 2 * n_ * j);
    if (to.t != nullptr) differentiate(at.h, {of_start_.t(), of_middle_.t(), of_end_.t()}, to.t);
    if (to.h != nullptr) differentiate_length(at.h, to.h);
    return 0;
  }

 private:
  static constexpr double keep_jacobian = 1e-3;  // size of a correction from which on the matrix is kept
  static constexpr double still = 1e-6;          // of the largest coordinate: smaller ones are treated as 0

  /// Derivatives of (P, R), 2 n rows, at one place.
  class Slopes {
   public:
    explicit Slopes(const Sizes& sizes)
        : rows_(sizes.states),
          by_state_(rows_ * rows_),
          by_time_(rows_),
          by_parameters_(rows_ * sizes.parameters),
          by_inputs_(rows_ * sizes.inputs) {}

    template <class F>
    int evaluate(const F& f, const Arguments& at, double t, const double* x, bool timed, const Derivatives& to) {
      int code = detail::momenta_jac(f, at, t, x, by_state_.data(), timed ? by_time_.data() : nullptr);
      if (code == 0 && to.p != nullptr) code = detail::momenta_jac_p(f, at, t, x, by_parameters_.data());
      if (code == 0 && to.u != nullptr) code = detail::momenta_jac_u(f, at, t, x, by_inputs_.data());
      return code;
    }
    /// Rows of P and R by coordinate or rate j.
    double P(std::size_t i, std::size_t j) const { return by_state_[i + rows_ * j]; }
    double R(std::size_t i, std::size_t j) const { return by_state_[rows_ / 2 + i + rows_ * j]; }
    const double* x(std::size_t j) const { return &by_state_[rows_ * j]; }
    const double* t() const { return by_time_.data(); }
    const double* p(std::size_t j) const { return &by_parameters_[rows_ * j]; }
    const double* u(std::size_t j) const { return &by_inputs_[rows_ * j]; }

   private:
    std::size_t rows_;
    std::vector<double> by_state_, by_time_, by_parameters_, by_inputs_;
  };

  /// Explicit derivatives of (P, R) by an argument of the step, at fixed coordinates and rates. Null: 0.
  struct Explicit {
    const double *start, *middle, *end;
  };

  /// (q + d/2, d/h).
  void place_middle(const Arguments& at) {
    for (std::size_t i = 0; i < n_; ++i) at_[i] = at.x[i] + 0.5 * d_[i], at_[n_ + i] = d_[i] / at.h;
  }

  /// K = d(P - h/2 R)/dd of the middle.
  int factor(double h) {
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t i = 0; i < n_; ++i)
        by_d_(i, j) = 0.5 * (of_middle_.P(i, j) - 0.5 * h * of_middle_.R(i, j)) +
                      (of_middle_.P(i, n_ + j) - 0.5 * h * of_middle_.R(i, n_ + j)) / h;
    return by_d_.factor() ? 0 : code_no_convergence;
  }
  int factor_end() {
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t i = 0; i < n_; ++i) by_rate_(i, j) = of_end_.P(i, n_ + j);
    return by_rate_.factor() ? 0 : code_no_convergence;
  }

  template <class F>
  int solve_middle(const F& f, const Arguments& at) {
    const double t = at.t + 0.5 * at.h;
    for (std::size_t i = 0; i < n_; ++i) d_[i] = at.h * at.x[n_ + i];
    implicit::RoundingConvergence convergence;
    for (bool anew = true;;) {
      place_middle(at);
      if (const int code = detail::momenta(f, at, t, at_.data(), middle_.data(), n_); code != 0) return code;
      if (anew) {
        if (const int code = of_middle_.evaluate(f, at, t, at_.data(), false, {}); code != 0) return code;
        if (const int code = factor(at.h); code != 0) return code;
      }
      for (std::size_t i = 0; i < n_; ++i) right_[i] = (start_[i] - middle_[i]) + 0.5 * at.h * middle_[n_ + i];
      by_d_.solve(right_.data());
      const double size = apply_correction(at);
      if (!std::isfinite(size)) return code_no_convergence;
      anew = size > keep_jacobian;
      switch (convergence.update(size)) {
        case implicit::RoundingConvergence::State::converged: return 0;
        case implicit::RoundingConvergence::State::failed: return code_no_convergence;
        case implicit::RoundingConvergence::State::iterating: break;
      }
    }
  }

  /// Adds the correction to d. Returns its size: the root mean square in units of the coordinates.
  double apply_correction(const Arguments& at) {
    double largest = 1e-300, sum = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      d_[i] += right_[i];
      largest = std::max({largest, std::abs(at.x[i]), std::abs(d_[i])});
    }
    for (std::size_t i = 0; i < n_; ++i) {
      const double part = right_[i] / std::max({std::abs(at.x[i]), std::abs(d_[i]), still * largest});
      sum += part * part;
    }
    return std::sqrt(sum / static_cast<double>(n_));
  }

  /// Sets at_ to (q1, v1). The momenta are linear in v1, but solved twice to reduce rounding.
  template <class F>
  int solve_end(const F& f, const Arguments& at) {
    place_middle(at);
    const double end = at.t + at.h;
    if (const int code = detail::momenta(f, at, at.t + 0.5 * at.h, at_.data(), middle_.data(), n_); code != 0)
      return code;
    for (std::size_t i = 0; i < n_; ++i) at_[i] = at.x[i] + d_[i];
    if (const int code = of_end_.evaluate(f, at, end, at_.data(), false, {}); code != 0) return code;
    if (const int code = factor_end(); code != 0) return code;
    for (int round = 0; round < 2; ++round) {
      if (const int code = detail::momenta(f, at, end, at_.data(), end_.data(), n_); code != 0) return code;
      for (std::size_t i = 0; i < n_; ++i) right_[i] = (start_[i] + at.h * middle_[n_ + i]) - end_[i];
      by_rate_.solve(right_.data());
      for (std::size_t i = 0; i < n_; ++i) at_[n_ + i] += right_[i];
    }
    return std::all_of(at_.begin(), at_.end(), [](double value) { return std::isfinite(value); }) ? 0 : code_not_finite;
  }

  /// By coordinate or rate j of the start. to: N.
  void differentiate_state(double h, std::size_t j, double* to) const {
    const bool is_coordinate = j < n_;
    differentiate(
        h, {of_start_.x(j), is_coordinate ? of_middle_.x(j) : nullptr, is_coordinate ? of_end_.x(j) : nullptr}, to);
    if (is_coordinate) to[j] += 1;  // q1 = q + d
  }

  /// The middle has the rates d/h and the time t + h/2.
  void differentiate_length(double h, double* to) {
    for (std::size_t i = 0; i < 2 * n_; ++i) {
      at_[i] = 0.5 * of_middle_.t()[i];
      for (std::size_t j = 0; j < n_; ++j) at_[i] -= of_middle_.x(n_ + j)[i] * d_[j] / (h * h);
    }
    differentiate(h, {nullptr, at_.data(), of_end_.t()}, to, middle_.data() + n_);
  }

  /// (q1', v1') for these explicit derivatives; q1' without that of q. `rate`: R, if h changes.
  void differentiate(double h, const Explicit& by, double* to, const double* rate = nullptr) const {
    double *const d = to, *const v = to + n_;
    for (std::size_t i = 0; i < n_; ++i) {
      d[i] = 0;
      if (by.start != nullptr) d[i] += by.start[i];
      if (by.middle != nullptr) d[i] -= by.middle[i] - 0.5 * h * by.middle[n_ + i];
      if (rate != nullptr) d[i] += 0.5 * rate[i];
    }
    by_d_.solve(d);
    for (std::size_t i = 0; i < n_; ++i) {
      double momentum = by.start != nullptr ? by.start[i] : 0, slope = by.middle != nullptr ? by.middle[n_ + i] : 0;
      for (std::size_t j = 0; j < n_; ++j) {
        slope += (0.5 * of_middle_.R(i, j) + of_middle_.R(i, n_ + j) / h) * d[j];
        momentum -= of_end_.P(i, j) * d[j];
      }
      v[i] = momentum + h * slope - (by.end != nullptr ? by.end[i] : 0) + (rate != nullptr ? rate[i] : 0);
    }
    by_rate_.solve(v);
  }

  Sizes sizes_;
  std::size_t n_;                                 // coordinates
  std::vector<double> d_, start_, middle_, end_;  // q1 - q; P and R at three places
  std::vector<double> at_, right_;
  Slopes of_start_, of_middle_, of_end_;
  Lu<double> by_d_, by_rate_;
};

}  // namespace eom::discrete
