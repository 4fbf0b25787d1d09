// SPDX-License-Identifier: MIT
// The state and its derivative at both ends of a step, for methods on a System; the statistics; the compensated sum x0
// + increment, whose remainder is carried along.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "eom/run_types.hpp"
#include "eom/system.hpp"

namespace eom {

/// Base of the methods on a System: n components at both ends of a step from x0 at t0 to x1 at t1. Its members are
/// those that drive.hpp requires of a method.
class StepEnds {
 public:
  /// `x`: the start, n components, which are copied.
  StepEnds(System& system, std::span<const double> x, const Options& options)
      : system_(system), n_(x.size()), fixed_(options.fixed_step > 0), ends_(7 * n_) {
    double* next = ends_.data();
    for (double** vector : {&x0_, &x1_, &f0_, &f1_, &scratch_, &carry_, &new_carry_})
      *vector = std::exchange(next, next + n_);
    std::copy(x.begin(), x.end(), x0_);
  }
  StepEnds(const StepEnds&) = delete;
  StepEnds& operator=(const StepEnds&) = delete;

  /// n.
  std::size_t size() const { return n_; }
  /// The state at the start of the step: n.
  double* x0() { return x0_; }
  /// The state at the end of the step: n.
  double* x1() { return x1_; }
  /// f(t0, x0): n.
  const double* derivative0() const { return f0_; }
  /// f(t1, x1): n.
  const double* derivative1() const { return f1_; }
  /// Work space for a state: n.
  double* scratch() { return scratch_; }
  /// Counts of the work so far.
  const Statistics& statistics() const { return counts_; }

  /// dx = f(t, x), counted. Returns its code.
  int evaluate(double t, const double* x, double* dx) {
    ++counts_.rhs_evaluations;
    return system_.f(system_.self, t, x, dx);
  }
  /// Evaluates derivative0() at t. Returns the code of f.
  int evaluate_start(double t) { return evaluate(t, x0_, f0_); }
  /// Evaluates derivative1(). Returns the code of f.
  int evaluate_end() { return evaluate(t1_, x1_, f1_); }

 protected:
  /// Begins a step from t0 to t1.
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

  /// Makes the end of the step the start of the next one. moved: a projection changed the end, so that the remainder of
  /// the sum is dropped.
  void swap_ends(bool moved) {
    std::swap(x0_, x1_);
    std::swap(f0_, f1_);
    if (moved)
      std::fill_n(carry_, n_, 0.0);
    else
      std::swap(carry_, new_carry_);
  }

  System& system_;
  std::size_t n_;
  bool fixed_;
  Statistics counts_;
  std::vector<double> ends_;
  double *x0_, *x1_, *f0_, *f1_, *scratch_, *carry_, *new_carry_;
  double t0_ = 0, t1_ = 0, h_ = 0;
};

}  // namespace eom
