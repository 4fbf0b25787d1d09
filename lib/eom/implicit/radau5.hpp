// SPDX-License-Identifier: MIT
// Radau IIA of order 5 for stiff systems. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.8:
// stage increments by simplified Newton iterations, transformed so that one real and one complex matrix are factored; an
// error estimate of order 3, filtered by the real matrix; step sizes predicted from two steps (Gustafsson); df/dx and the
// factors are kept as long as the iteration converges fast.
//
// The estimate is of lower order than the method. So that the step's own error stays in proportion to the tolerance r, it is
// compared with r^(2/3)/10.
// Dense output: the collocation polynomial (order 3) and, towards the derivative at the start, the filtered estimate times
// a quartic; this makes it order 4 at no cost, and leaves it where the filter damps.
// With fixed steps there is no tolerance: the iteration goes on to rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "eom/implicit/base.hpp"
#include "eom/implicit/newton.hpp"
#include "eom/implicit/radau5_tableau.hpp"

namespace eom::implicit {

class Radau5 : public Base {
 public:
  static constexpr const char* name = "radau5";
  static constexpr int order = 5;
  static constexpr int dense_order = 4;
  static constexpr bool adaptive = true;
  static constexpr bool error_uses_end = false;

  Radau5(Problem& problem, std::span<const double> x, const Options& options)
      : Base(problem, x, options, Jacobian::Differences::one_sided),
        real_(m_), complex_(m_), work_((3 + 3 + 3 + 3 + 2) * n_), pair_(m_) {
    double* next = work_.data();
    for (double** block : {&z_, &w_, &f_, &z_before_}) *block = std::exchange(next, next + 3 * n_);
    estimate_ = std::exchange(next, next + n_);
    right_ = next;
    set_tolerances(options, x);
  }

  /// Trial state at t1; a code of the right-hand side, or code_no_convergence.
  int attempt(double t0, double t1) {
    open(t0, t1);
    if (jacobian_wanted_ || !jacobian_known_)
      if (const int code = new_jacobian(); code != 0) return code;
    while (true) {
      if (!factored_ || std::abs(h_ - h_factored_) > same_step * std::abs(h_))
        if (!factor()) {
          fail(0.5);
          return code_no_convergence;
        }
      start_values();
      int code = 0;
      if (iterate(code)) break;
      if (code != 0) return code;
      ++counts_.newton_failures;
      if (jacobian_here_) return code_no_convergence;
      if ((code = new_jacobian()) != 0) return code;
    }
    return finish();
  }

  double error_norm(double rtol, double atol) {
    const auto scale = [&](std::size_t i) { return loosened_ * (atol + rtol * std::max(std::abs(x0_[i]), std::abs(x1_[i]))); };
    double error = norm([&](std::size_t i) { return estimate_[i]; }, scale);
    if (error >= 1 && (rejected_ || !accepted_)) {  // once more through the filter: less is asked of a stiff start
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + (i < m_ ? estimate_[i] : 0);
      if (evaluate(t0_, scratch_, right_) == 0) {
        for (std::size_t i = 0; i < m_; ++i) right_[i] += defect(i) / h_;
        real_.solve(right_);
        const double again = norm([&](std::size_t i) { return right_[i]; }, scale);
        if (std::isfinite(again)) error = again;
      }
    }
    return std::max(error, 1e-10);
  }

  double after_accepted(double h, double error) {
    double quotient = step_quotient(error);
    if (accepted_) {
      const double predicted = h_before_ / h * std::pow(error * error / error_before_, 0.25) / safety;
      quotient = std::max(quotient, std::clamp(predicted, 1 / most_growth, most_shrinking));
    }
    h_before_ = h;
    error_before_ = std::max(error, 1e-2);
    double next = h / quotient;
    if (rejected_) next = std::min(next, h);
    rejected_ = false;
    accepted_ = true;
    if (contraction_ <= keep_jacobian && next >= h && next <= 1.2 * h) return h;  // the factors stay
    return next;
  }

  double after_rejected(double h, double error) {
    jacobian_wanted_ = !jacobian_here_;
    rejected_ = true;
    return accepted_ ? std::min(h / step_quotient(error), 0.95 * h) : 0.1 * h;
  }

  double after_failed(double h) {
    jacobian_wanted_ = !jacobian_here_;
    rejected_ = true;
    return h * std::exchange(after_failure_, 0.25);
  }

  void accept(bool moved) {
    std::swap(z_, z_before_);
    h_of_before_ = h_;
    jacobian_here_ = false;
    jacobian_wanted_ = contraction_ > keep_jacobian;
    swap_ends(moved);
  }

  static void interpolate(const void* method, double t, double* x) { static_cast<const Radau5*>(method)->interpolate(t, x); }

  void interpolate(double t, double* x) const {
    const double s = (t - t0_) / h_;
    for (std::size_t i = 0; i < n_; ++i) {
      const double towards_slope = i < m_ ? radau::gamma0 * estimate_[i] : defect(i);
      const double moved = x1_[i] - (x0_[i] + z_[2 * n_ + i]);  // by after_step, and by rounding
      x[i] = x0_[i] + (radau::collocation(s, z_[i], z_[n_ + i], z_[2 * n_ + i]) + radau::bump(s) * towards_slope + s * moved);
    }
  }

 private:
  static constexpr double safety = 0.9;
  static constexpr double most_growth = 8;
  static constexpr double most_shrinking = 5;
  static constexpr double keep_jacobian = 1e-3;  // of the contraction of Newton's iteration
  static constexpr double same_step = 1e-9;
  static constexpr int most_iterations = 7;

  void set_tolerances(const Options& options, std::span<const double> x) {
    double largest = 0;
    for (std::size_t i = 0; i < m_; ++i) largest = std::max(largest, std::abs(x[i]));
    const double of_atol = options.atol > 0 ? options.atol / std::max(largest, 1e-300) : 0;
    const double tolerance = std::clamp(std::max(options.rtol, of_atol), 10 * epsilon, 1e-3);
    loosened_ = 0.1 / std::cbrt(tolerance);
    rtol_ = loosened_ * options.rtol;
    atol_ = loosened_ * options.atol;
    const double compared = loosened_ * tolerance;
    newton_tolerance_ = std::max(10 * epsilon / compared, std::min(0.03, std::sqrt(compared)));
  }

  int new_jacobian() {
    const int code = jacobian_.evaluate(t0_, x0_, f0_, h_, counts_);
    jacobian_known_ = jacobian_here_ = code == 0;
    jacobian_wanted_ = factored_ = false;
    return code;
  }

  bool factor() {
    ++counts_.factorisations;
    for (std::size_t j = 0; j < m_; ++j)
      for (std::size_t i = 0; i < m_; ++i) {
        const double diagonal = i == j ? 1 / h_ : 0, entry = jacobian_(i, j);
        real_(i, j) = radau::gamma0 * diagonal - entry;
        complex_(i, j) = {radau::alpha * diagonal - entry, radau::beta * diagonal};
      }
    h_factored_ = h_;
    return factored_ = real_.factor() && complex_.factor();
  }

  /// The iteration is given up; such a part of the step is tried next.
  bool fail(double part) {
    after_failure_ = part;
    return false;
  }

  /// The polynomial of the step before, continued; zero where there is none.
  void start_values() {
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = h_of_before_ != 0 ? 1 + radau::c[k] * h_ / h_of_before_ : 0;
      for (std::size_t i = 0; i < n_; ++i) {
        const double* z = z_before_ + i;
        z_[k * n_ + i] = h_of_before_ == 0 || i >= m_ ? 0 : radau::collocation(s, z[0], z[n_], z[2 * n_]) - z[2 * n_];
      }
    }
    transform(radau::T_inverse, z_, w_);
  }

  void transform(const double (&by)[3][3], const double* from, double* to) const {
    for (std::size_t i = 0; i < m_; ++i) {
      const double a = from[i], b = from[n_ + i], d = from[2 * n_ + i];
      for (std::size_t k = 0; k < 3; ++k) to[k * n_ + i] = by[k][0] * a + by[k][1] * b + by[k][2] * d;
    }
  }

  int evaluate_stages() {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + z_[k * n_ + i];
      if (const int code = evaluate(t0_ + radau::c[k] * h_, scratch_, f_ + k * n_); code != 0) return code;
    }
    return std::all_of(f_, f_ + 3 * n_, [](double value) { return std::isfinite(value); }) ? 0 : code_not_finite;
  }

  /// One simplified Newton iteration from stage derivatives in f_; returns the size of the correction.
  double correct() {
    transform(radau::T_inverse, f_, f_);
    for (std::size_t i = 0; i < m_; ++i) {
      const double w1 = w_[i] / h_, w2 = w_[n_ + i] / h_, w3 = w_[2 * n_ + i] / h_;
      right_[i] = f_[i] - radau::gamma0 * w1;
      pair_[i] = {f_[n_ + i] - radau::alpha * w2 + radau::beta * w3, f_[2 * n_ + i] - radau::alpha * w3 - radau::beta * w2};
    }
    real_.solve(right_);
    complex_.solve(pair_.data());
    for (std::size_t i = 0; i < m_; ++i) {
      w_[i] += right_[i];
      w_[n_ + i] += pair_[i].re;
      w_[2 * n_ + i] += pair_[i].im;
    }
    const double size = norm([&](std::size_t i) { return std::hypot(right_[i], pair_[i].re, pair_[i].im); },
                             [&](std::size_t i) { return newton_scale(i); });
    transform(radau::T, w_, z_);
    return size / std::sqrt(3.0);
  }

  double newton_scale(std::size_t i) const {
    const double size = std::max(std::abs(x0_[i]), std::abs(x0_[i] + z_[2 * n_ + i]));
    const double scale = fixed_ ? size : atol_ + rtol_ * size;
    return scale > 0 ? scale : std::max(std::abs(h_ * f0_[i]), 1e-300);
  }

  /// Newton's iteration; false with a code of the right-hand side, or 0 where it does not converge.
  bool iterate(int& code) {
    remaining_ = std::pow(std::max(remaining_, epsilon), 0.8);
    contraction_ = keep_jacobian;
    ToRounding to_rounding;
    double before = 0, ratio_before = 0;
    for (newton_ = 1; fixed_ || newton_ <= most_iterations; ++newton_) {
      if ((code = evaluate_stages()) != 0) return false;
      ++counts_.newton_iterations;
      const double size = correct();
      if (!std::isfinite(size)) return fail(0.5);
      if (fixed_) {
        const ToRounding::State state = to_rounding.see(size);
        contraction_ = to_rounding.contraction();
        if (state != ToRounding::State::goes_on) return state == ToRounding::State::converged || fail(0.5);
        continue;
      }
      if (newton_ > 1 && newton_ < most_iterations) {
        const double ratio = size / before;
        contraction_ = newton_ == 2 ? ratio : std::sqrt(ratio * ratio_before);
        ratio_before = ratio;
        if (contraction_ >= 0.99) return fail(0.5);
        remaining_ = contraction_ / (1 - contraction_);
        const int left = most_iterations - 1 - newton_;
        const double expected = remaining_ * size * std::pow(contraction_, left) / newton_tolerance_;
        if (expected >= 1) return fail(0.8 * std::pow(std::min(expected, 20.0), -1.0 / (4 + left)));
      }
      before = std::max(size, epsilon * epsilon);
      if (remaining_ * size <= newton_tolerance_) return true;
    }
    return fail(0.5);
  }

  /// x1, the quadratures and the filtered estimate.
  int finish() {
    if (m_ < n_) {
      if (const int code = evaluate_stages(); code != 0) return code;
      for (std::size_t i = m_; i < n_; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          const double* a = radau::A[k];
          z_[k * n_ + i] = h_ * (a[0] * f_[i] + a[1] * f_[n_ + i] + a[2] * f_[2 * n_ + i]);
        }
    }
    for (std::size_t i = 0; i < n_; ++i) advance(i, z_[2 * n_ + i]);
    for (std::size_t i = 0; i < m_; ++i) estimate_[i] = f0_[i] + defect_of_stages(i) / h_;
    real_.solve(estimate_);
    return 0;
  }

  double defect_of_stages(std::size_t i) const {
    const auto& d = radau::slope_defect;
    return d[0] * z_[i] + d[1] * z_[n_ + i] + d[2] * z_[2 * n_ + i];
  }
  double defect(std::size_t i) const { return (i < m_ ? 0 : h_ * f0_[i]) + defect_of_stages(i); }

  double step_quotient(double error) const {
    const double factor = std::min(safety, safety * (1 + 2 * most_iterations) / (newton_ + 2 * most_iterations));
    return std::clamp(std::pow(error, 0.25) / factor, 1 / most_growth, most_shrinking);
  }

  Lu<double> real_;
  Lu<Complex> complex_;
  std::vector<double> work_;
  std::vector<Complex> pair_;
  double *z_, *w_, *f_, *z_before_;  // stage increments, transformed, stage derivatives; of the step before
  double *estimate_, *right_;
  double loosened_ = 1, rtol_ = 0, atol_ = 0, newton_tolerance_ = 0;
  double h_factored_ = 0, h_of_before_ = 0;
  double contraction_ = 0, remaining_ = 1;
  double h_before_ = 0, error_before_ = 1;
  double after_failure_ = 0.25;
  int newton_ = 0;
  bool jacobian_known_ = false, jacobian_here_ = false, jacobian_wanted_ = false, factored_ = false;
  bool accepted_ = false, rejected_ = false;
};

}  // namespace eom::implicit
