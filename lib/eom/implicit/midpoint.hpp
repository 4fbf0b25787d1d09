// SPDX-License-Identifier: MIT
// The implicit midpoint rule, x1 = x0 + h f(t0 + h/2, (x0 + x1)/2): order 2, fixed steps, symmetric in time, symplectic
// for Hamiltonian systems. It preserves every quadratic invariant. Source: Hairer, Lubich, Wanner, Geometric Numerical
// Integration, chapters II, IV, VI. These properties require an accurate solution of the equation, so Newton's
// iteration continues to rounding. Dense output: the Hermite cubic, whose error is that of the step.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "eom/implicit/base.hpp"
#include "eom/implicit/hermite.hpp"
#include "eom/implicit/newton.hpp"

namespace eom::implicit {

/// The method `midpoint`.
class Midpoint : public Base {
 public:
  static constexpr const char* name = "midpoint";
  static constexpr int order = 2;
  static constexpr int dense_order = 2;
  static constexpr bool adaptive = false;
  static constexpr bool error_uses_end = false;
  static constexpr Needs needs{.used = {Feature::jacobian}};

  Midpoint(System& system, std::span<const double> x, const Options& options)
      : Base(system, x, options, Jacobian::Differences::one_sided), lu_(m_), units_(m_, m_), work_(3 * n_) {
    z_ = work_.data();
    f_ = z_ + n_;
    right_ = f_ + n_;
  }

  /// Computes the trial state at t1. Returns a code of the right-hand side, or code_no_convergence.
  int attempt(double t0, double t1) {
    open(t0, t1);
    for (bool anew = jacobian_wanted_;; anew = true) {
      if (anew) {
        if (const int code = jacobian_.evaluate(t0_, x0_, f0_, h_, counts_); code != 0) return code;
        factored_ = jacobian_wanted_ = false;
      }
      if ((!factored_ || std::abs(h_ - h_factored_) > 1e-9 * std::abs(h_)) && !factor()) return code_no_convergence;
      const int code = iterate();
      if (code == 0) return finish();
      if (code != code_no_convergence) return code;
      ++counts_.newton_failures;
      if (anew) return code;
    }
  }

  // no error estimate and no step size control: with fixed steps the driver does not use them
  double error_norm(double, double) { return 0; }
  double after_accepted(double h, double) { return h; }
  double after_rejected(double h, double) { return h; }
  double after_failed(double h) { return h; }

  void accept(bool moved) { swap_ends(moved); }

  static void interpolate(const void* method, double t, double* x) {
    static_cast<const Midpoint*>(method)->interpolate(t, x);
  }

  void interpolate(double t, double* x) const { hermite((t - t0_) / h_, h_, n_, x0_, f0_, x1_, f1_, x); }

 private:
  static constexpr double keep_jacobian = 1e-2;  // of the contraction of Newton's iteration

  bool factor() {
    ++counts_.factorisations;
    for (std::size_t j = 0; j < m_; ++j)
      for (std::size_t i = 0; i < m_; ++i) lu_(i, j) = (i == j ? 1 : 0) - 0.5 * h_ * jacobian_(i, j);
    h_factored_ = h_;
    return factored_ = lu_.factor();
  }

  /// Evaluates f_ at the middle, x0 + z.
  int evaluate_middle() {
    for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + z_[i];
    const int code = evaluate(t0_ + 0.5 * h_, scratch_, f_);
    if (code != 0) return code;
    return std::all_of(f_, f_ + n_, [](double value) { return std::isfinite(value); }) ? 0 : code_not_finite;
  }

  /// Solves z = h/2 f(t0 + h/2, x0 + z).
  int iterate() {
    for (std::size_t i = 0; i < n_; ++i) z_[i] = i < m_ ? 0.5 * h_ * f0_[i] : 0;
    units_.compute(
        jacobian_, x0_, f0_, h_, 0.5 * h_, [&](double* w) { lu_.solve(w); }, [](double*, const auto&) {});
    RoundingConvergence convergence;
    while (true) {
      if (const int code = evaluate_middle(); code != 0) return code;
      ++counts_.newton_iterations;
      for (std::size_t i = 0; i < m_; ++i) right_[i] = 0.5 * h_ * f_[i] - z_[i];
      lu_.solve(right_);
      for (std::size_t i = 0; i < m_; ++i) z_[i] += right_[i];
      const double size = norm(
          [&](std::size_t i) { return right_[i]; },
          [&](std::size_t i) { return units_(i, std::max(std::abs(x0_[i]), std::abs(x0_[i] + z_[i])), right_[i]); });
      const RoundingConvergence::State state = convergence.update(size);
      jacobian_wanted_ = convergence.contraction() > keep_jacobian;
      if (state == RoundingConvergence::State::converged) return 0;
      if (state == RoundingConvergence::State::failed || !std::isfinite(size)) return code_no_convergence;
    }
  }

  int finish() {
    if (m_ < n_)
      if (const int code = evaluate_middle(); code != 0) return code;
    for (std::size_t i = 0; i < n_; ++i) advance(i, i < m_ ? 2 * z_[i] : h_ * f_[i]);
    return 0;
  }

  Lu<double> lu_;
  CorrectionUnits units_;
  std::vector<double> work_;
  double *z_, *f_, *right_;  // half the step's increment, the derivative in the middle, a correction
  double h_factored_ = 0;
  bool jacobian_wanted_ = true, factored_ = false;
};

}  // namespace eom::implicit
