// SPDX-License-Identifier: MIT
// One step of the implicit midpoint rule, x1 = x + h f(t + h/2, (x + x1)/2), and its exact derivatives. In: functions
// of a model. Out: x1, solved to rounding, and derivatives by the implicit function theorem. With J = df/dx, f_t, f_p,
// f_u in the middle, and a derivative ',
//   (I - h/2 J) x1' = (I + h/2 J) x' + h f_t (t' + h'/2) + h f_p p' + h f_u u' + f h'.
// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, chapters II, IV, VI. Newton's iteration takes a new
// Jacobian until a correction is small, so that large steps converge too. Allocates in the constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eom/discrete/functions.hpp"
#include "eom/implicit/newton.hpp"
#include "eom/linalg/lu.hpp"
#include "eom/outcome.hpp"

namespace eom::discrete {

class Midpoint {
 public:
  static constexpr const char* name = "midpoint";
  static constexpr int order = 2;

  explicit Midpoint(const Sizes& sizes)
      : sizes_(sizes),
        n_(sizes.states),
        z_(n_),
        middle_(n_),
        slope_(n_),
        correction_(n_),
        rounding_(n_),
        by_time_(n_),
        jacobian_(n_ * n_),
        lu_(n_) {}

  /// x1: N. Returns a code of the functions, code_no_function without jac, or code_no_convergence.
  template <class F>
  int step(const F& f, const Arguments& at, double* x1) {
    if (const int code = solve(f, at); code != 0) return code;
    for (std::size_t i = 0; i < n_; ++i) x1[i] = at.x[i] + 2 * z_[i];
    return 0;
  }

  /// The same with derivatives.
  template <class F>
  int derivatives(const F& f, const Arguments& at, double* x1, const Derivatives& to) {
    if (const int code = step(f, at, x1); code != 0 || !to.any()) return code;
    const double t = at.t + 0.5 * at.h;
    for (std::size_t i = 0; i < n_; ++i) middle_[i] = at.x[i] + z_[i];
    if (to.h != nullptr)
      if (const int code = detail::rhs(f, at, t, middle_.data(), slope_.data()); code != 0) return code;
    if (const int code = factor(f, at, t, to.t != nullptr || to.h != nullptr); code != 0) return code;
    if (to.p != nullptr)
      if (const int code = detail::jac_p(f, at, t, middle_.data(), to.p); code != 0) return code;
    if (to.u != nullptr)
      if (const int code = detail::jac_u(f, at, t, middle_.data(), to.u); code != 0) return code;
    if (to.x != nullptr)
      for (std::size_t j = 0; j < n_; ++j)
        for (std::size_t i = 0; i < n_; ++i) to.x[i + n_ * j] = (i == j ? 1 : 0) + 0.5 * at.h * jacobian_[i + n_ * j];
    scale(to.p, sizes_.parameters, at.h);
    scale(to.u, sizes_.inputs, at.h);
    for (std::size_t i = 0; i < n_; ++i) {
      if (to.t != nullptr) to.t[i] = at.h * by_time_[i];
      if (to.h != nullptr) to.h[i] = slope_[i] + 0.5 * at.h * by_time_[i];
    }
    solve_columns(to.x, n_);
    solve_columns(to.p, sizes_.parameters);
    solve_columns(to.u, sizes_.inputs);
    solve_columns(to.t, 1);
    solve_columns(to.h, 1);
    return 0;
  }

 private:
  static constexpr double keep_jacobian = 1e-3;  // size of a correction from which on the matrix is kept
  static constexpr double smallest = 1e-6;       // part of the rounding of the others that resolves a component

  void scale(double* columns, std::size_t count, double by) const {
    if (columns == nullptr) return;
    for (std::size_t k = 0; k < n_ * count; ++k) columns[k] *= by;
  }
  void solve_columns(double* columns, std::size_t count) const {
    if (columns == nullptr) return;
    for (std::size_t k = 0; k < count; ++k) lu_.solve(columns + n_ * k);
  }

  /// Evaluates J at `middle_` and factors I - h/2 J.
  template <class F>
  int factor(const F& f, const Arguments& at, double t, bool timed) {
    const int code = detail::jac(f, at, t, middle_.data(), jacobian_.data(), timed ? by_time_.data() : nullptr);
    if (code != 0) return code;
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t i = 0; i < n_; ++i) lu_(i, j) = (i == j ? 1 : 0) - 0.5 * at.h * jacobian_[i + n_ * j];
    return lu_.factor() ? 0 : code_no_convergence;
  }

  /// The rounding that the components inherit from each other, as in implicit::CorrectionUnits.
  void find_rounding(const Arguments& at) {
    least_ = 0;
    std::fill(rounding_.begin(), rounding_.end(), 0.0);
    for (std::size_t j = 0; j < n_; ++j) {
      const double size = std::max(std::abs(at.x[j]), std::abs(2 * z_[j]));
      least_ = std::max(least_, 1e-25 * size);
      for (std::size_t i = 0; i < n_; ++i)
        rounding_[i] += std::abs(jacobian_[i + n_ * j]) * 0.5 * std::abs(at.h) * size;
    }
    for (std::size_t i = 0; i < n_; ++i)
      rounding_[i] *= 1 + 0.1 * static_cast<double>(i % 7);  // prevents symmetries of the matrix from making one 0
    lu_.solve(rounding_.data());
  }

  /// Solves z = h/2 f(t + h/2, x + z).
  template <class F>
  int solve(const F& f, const Arguments& at) {
    if (const int code = detail::rhs(f, at, at.t, at.x, slope_.data()); code != 0) return code;
    for (std::size_t i = 0; i < n_; ++i) z_[i] = 0.5 * at.h * slope_[i];
    const double t = at.t + 0.5 * at.h;
    implicit::RoundingConvergence convergence;
    for (bool anew = true;;) {
      for (std::size_t i = 0; i < n_; ++i) middle_[i] = at.x[i] + z_[i];
      if (const int code = detail::rhs(f, at, t, middle_.data(), slope_.data()); code != 0) return code;
      if (anew) {
        if (const int code = factor(f, at, t, false); code != 0) return code;
        find_rounding(at);
      }
      for (std::size_t i = 0; i < n_; ++i) correction_[i] = 0.5 * at.h * slope_[i] - z_[i];
      lu_.solve(correction_.data());
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

  /// Adds the correction to z. Returns its size: the root mean square in units of the components.
  double apply_correction(const Arguments& at) {
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double by = correction_[i];
      z_[i] += by;
      if (by == 0) continue;
      const double unit = std::max(
          {std::abs(at.x[i]), std::abs(at.x[i] + z_[i]), smallest * std::abs(rounding_[i]), least_, std::abs(by)});
      sum += by / unit * (by / unit);
    }
    return std::sqrt(sum / static_cast<double>(n_));
  }

  Sizes sizes_;
  std::size_t n_;
  std::vector<double> z_;               // half the increment
  std::vector<double> middle_, slope_;  // x + z, and f there
  std::vector<double> correction_, rounding_, by_time_, jacobian_;
  double least_ = 0;
  Lu<double> lu_;  // of I - h/2 J
};

}  // namespace eom::discrete
