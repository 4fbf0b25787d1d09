// SPDX-License-Identifier: MIT
// What the implicit methods have in common: the state at both ends of a step and its derivatives, what was counted, the
// sum x0 + increment with its remainder carried along (compensated summation), norms in units of the tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "eom/implicit/jacobian.hpp"
#include "eom/linalg/lu.hpp"
#include "eom/system.hpp"

namespace eom::implicit {

class Base {
 public:
  Base(System& system, std::span<const double> x, const Options& options, Jacobian::Differences differences)
      : system_(system),
        n_(x.size()),
        m_(x.size() - options.quadratures),
        fixed_(options.fixed_step > 0),
        jacobian_(system, n_, m_, options.rtol > 0 ? options.atol / options.rtol : 0, differences),
        ends_(7 * n_) {
    double* next = ends_.data();
    for (double** vector : {&x0_, &x1_, &f0_, &f1_, &scratch_, &carry_, &new_carry_})
      *vector = std::exchange(next, next + n_);
    std::copy(x.begin(), x.end(), x0_);
  }
  Base(const Base&) = delete;
  Base& operator=(const Base&) = delete;

  std::size_t size() const { return n_; }
  double* x0() { return x0_; }
  double* x1() { return x1_; }
  const double* derivative0() const { return f0_; }
  const double* derivative1() const { return f1_; }
  double* scratch() { return scratch_; }
  const Statistics& statistics() const { return counts_; }

  int evaluate(double t, const double* x, double* dx) {
    ++counts_.rhs_evaluations;
    return system_.f(system_.self, t, x, dx);
  }
  int evaluate_start(double t) { return evaluate(t, x0_, f0_); }
  /// Instead of evaluate_start, where the derivative at x0 is known.
  void start_with_derivative(const double* f) { std::copy_n(f, n_, f0_); }
  const Jacobian& jacobian() const { return jacobian_; }
  int evaluate_end() { return evaluate(t1_, x1_, f1_); }

 protected:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  void open(double t0, double t1) {
    t0_ = t0;
    t1_ = t1;
    h_ = t1 - t0;
  }

  /// x1 = x0 + increment in component i.
  void advance(std::size_t i, double increment) {
    increment += carry_[i];
    const double sum = x0_[i] + increment;
    const double taken = sum - x0_[i];  // Knuth's two-sum, as in explicit_rk/step.hpp
    new_carry_[i] = (x0_[i] - (sum - taken)) + (increment - taken);
    x1_[i] = sum;
  }

  void swap_ends(bool moved) {
    std::swap(x0_, x1_);
    std::swap(f0_, f1_);
    if (moved)
      std::fill_n(carry_, n_, 0.0);
    else
      std::swap(carry_, new_carry_);
  }

  /// Root mean square of m components in units of `scale`; one without a unit (atol 0 at 0) counts only where it moves.
  template <class Component, class Scale>
  double norm(Component component, Scale scale) const {
    double sum = 0;
    for (std::size_t i = 0; i < m_; ++i) {
      const double value = component(i);
      if (value == 0) continue;
      const double part = value / scale(i);
      sum += part * part;
    }
    return std::sqrt(sum / static_cast<double>(m_));
  }

  System& system_;
  std::size_t n_, m_;
  bool fixed_;
  Jacobian jacobian_;
  Statistics counts_;
  std::vector<double> ends_;
  double *x0_, *x1_, *f0_, *f1_, *scratch_, *carry_, *new_carry_;
  double t0_ = 0, t1_ = 0, h_ = 0;
};

}  // namespace eom::implicit
