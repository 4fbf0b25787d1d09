// SPDX-License-Identifier: MIT
// df/dx and df/dt, from the right-hand side's own function or by differences. In: a system, a state and its derivative.
// Out: matrix and vector, and their cost. Quadratures, the last components of x, are excluded: nothing depends on them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "eom/system.hpp"
#include "eom/with_jacobian.hpp"

namespace eom::implicit {

class Jacobian {
 public:
  enum class Differences { one_sided, central };  // central: for methods whose order needs the derivatives

  /// n components, of which the first m count; smallest: components below this size are treated as 0.
  Jacobian(const System& system, std::size_t n, std::size_t m, double smallest, Differences differences)
      : system_(system),
        n_(n),
        m_(m),
        smallest_(smallest),
        differences_(differences),
        dfdx_(m * m),
        dfdt_(m),
        x_(n),
        up_(n),
        down_(n) {}

  double operator()(std::size_t i, std::size_t j) const { return dfdx_[i + m_ * j]; }
  double dfdt(std::size_t i) const { return dfdt_[i]; }

  /// Estimate of |lambda| of the fastest motion: power iteration on the square, which is exact for a pair of
  /// eigenvalues. v, w: work space, m each.
  double estimate_spectral_radius(double* v, double* w) const {
    for (std::size_t i = 0; i < m_; ++i) v[i] = 1 + 0.5 * static_cast<double>(i % 3);
    const auto times = [&](const double* from, double* to) {
      double size = 0;
      for (std::size_t i = 0; i < m_; ++i) {
        to[i] = 0;
        for (std::size_t j = 0; j < m_; ++j) to[i] += (*this)(i, j) * from[j];
        size = std::hypot(size, to[i]);
      }
      return size;
    };
    double before = 0, after = 0;
    for (std::size_t i = 0; i < m_; ++i) before = std::hypot(before, v[i]);
    for (int twice = 0; twice < 2; ++twice) {
      if (twice > 0) before = after;
      if (!(before > 0)) return 0;
      times(v, w);
      after = times(w, v);
    }
    return std::sqrt(after / before);
  }

  /// Evaluates at (t, x) with right-hand side f; h: the step in which it will be used. Returns a code.
  int evaluate(double t, const double* x, const double* f, double h, Statistics& counts) {
    ++counts.jacobians;
    bool given = false;
    if (system_.jacobian != nullptr) {
      const int code = system_.jacobian(system_.self, t, x, dfdx_.data(), dfdt_.data());
      const bool complete = code == 0 || (code == no_time_derivative_here && differences_ == Differences::one_sided);
      // The derivative of a function may overflow where the function does not: sinh(x)/cosh(x)^2 beside 1/cosh(x).
      given = (complete || code == no_time_derivative_here) && all_finite();
      if (complete && given) return 0;
      if (!complete && code != no_jacobian_here && code != no_time_derivative_here && code != code_not_finite)
        return code;
    }
    const std::size_t before = counts.rhs_evaluations;
    std::copy_n(x, n_, x_.data());
    int code = given ? 0 : in_state(t, x, f, h, counts);
    if (code == 0 && differences_ == Differences::central) code = in_time(t, f, h, counts);  // not needed by the others
    counts.difference_evaluations += counts.rhs_evaluations - before;
    return code != 0 || all_finite() ? code : code_not_finite;
  }

 private:
  /// Relative sizes of differences: the cube root and the square root of the rounding.
  double part() const { return differences_ == Differences::central ? 6e-6 : 1.5e-8; }

  int in_state(double t, const double* x, const double* f, double h, Statistics& counts) {
    double largest = 0;
    for (std::size_t j = 0; j < m_; ++j) largest = std::max(largest, std::abs(x[j]));
    for (std::size_t j = 0; j < m_; ++j) {
      double size =
          std::max({std::abs(x[j]), std::abs(h * f[j]), largest > 0 ? std::min(smallest_, largest) : smallest_});
      if (size == 0) size = largest > 0 ? largest : 1;
      const int code = quotient(
          part() * size, f, &dfdx_[m_ * j], counts,
          [&](double by) {
            x_[j] = x[j] + by;
            return x_[j] - x[j];
          },
          [&] { return t; });
      x_[j] = x[j];
      if (code != 0) return code;
    }
    return 0;
  }

  int in_time(double t, const double* f, double h, Statistics& counts) {
    double at = t;
    const double size = std::max(part() * std::abs(h), 64 * std::numeric_limits<double>::epsilon() * std::abs(t));
    return quotient(
        size, f, dfdt_.data(), counts,
        [&](double by) {
          at = t + by;
          return at - t;
        },
        [&] { return at; });
  }

  /// The difference quotient: f at +size minus f at -size, or minus f itself. move(by) returns the actual displacement
  /// in binary64.
  template <class Move, class Time>
  int quotient(double size, const double* f, double* result, Statistics& counts, Move move, Time time) {
    const double ahead = move(size);
    const int code_up = evaluate(time(), up_.data(), counts);
    if (code_up == 0 && differences_ == Differences::one_sided) return divide(up_.data(), f, ahead, result);
    const double back = move(-size);
    const int code_down = evaluate(time(), down_.data(), counts);
    if (code_up != 0 && code_down != 0) return code_up;
    if (code_up != 0) return divide(down_.data(), f, back, result);  // at the boundary of the domain
    if (code_down != 0) return divide(up_.data(), f, ahead, result);
    return divide(up_.data(), down_.data(), ahead - back, result);
  }

  int evaluate(double t, double* dx, Statistics& counts) {
    ++counts.rhs_evaluations;
    return system_.f(system_.self, t, x_.data(), dx);
  }

  int divide(const double* a, const double* b, double by, double* result) const {
    for (std::size_t i = 0; i < m_; ++i) result[i] = (a[i] - b[i]) / by;
    return 0;
  }

  bool all_finite() const {
    return std::all_of(dfdx_.begin(), dfdx_.end(), [](double value) { return std::isfinite(value); });
  }

  System system_;
  std::size_t n_, m_;
  double smallest_;
  Differences differences_;
  std::vector<double> dfdx_, dfdt_, x_, up_, down_;
};

}  // namespace eom::implicit
