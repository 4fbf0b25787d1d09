// SPDX-License-Identifier: MIT
// The step sequence of one member, with the decisions of drive.hpp, so that its steps are bitwise equal to those of a
// single run. In: the result of a trial step. Out: the next step, or the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "eom/ensemble/members.hpp"

namespace eom::ensemble {

/// Steps: after_accepted(h, error), after_rejected(h, error), after_failed(h) give the next step's size.
template <class Steps>
class Lane {
 public:
  Lane(std::size_t member, double t0, double t1, const Steps& steps)
      : member_(member), t_start_(t0), t_(t0), t_end_(t1), direction_(t1 < t0 ? -1.0 : 1.0), steps_(steps) {}

  std::size_t member() const { return member_; }
  double t() const { return t_; }
  double direction() const { return direction_; }
  bool at_end() const { return t_ == t_end_; }
  Outcome outcome() const { return outcome_; }
  void count(std::size_t evaluations) { statistics_.rhs_evaluations += evaluations; }
  void count_matrix() { ++statistics_.jacobians; }
  void count_factorisation() { ++statistics_.factorisations; }
  void fall_back() { ++statistics_.dense_fallbacks; }
  Steps& steps() { return steps_; }
  const Steps& steps() const { return steps_; }
  const Statistics& statistics() const { return statistics_; }
  double longest_step(const EnsembleOptions& options) const {
    return std::min(options.max_step, std::abs(t_end_ - t_start_));
  }

  void start_with(double h, const EnsembleOptions& options) {
    h_ = std::min(std::max(h, smallest_step(t_)), longest_step(options));
  }
  /// The smallest sufficient number of equal steps. False: the run ends here.
  bool plan_fixed_steps(const EnsembleOptions& options) {
    const double quotient = std::abs(t_end_ - t_start_) / options.fixed_step;
    fixed_steps_ = std::max(1.0, std::ceil(quotient * (1 - 8 * std::numeric_limits<double>::epsilon())));
    if (fixed_steps_ > 1 && options.fixed_step < smallest_step(std::max(std::abs(t_start_), std::abs(t_end_))))
      return end(Outcome::step_too_small);
    return true;
  }

  /// Whether another step is allowed.
  bool has_steps_left(const EnsembleOptions& options) {
    return statistics_.steps + statistics_.rejected < options.max_steps || end(Outcome::max_steps);
  }

  double next_time(const EnsembleOptions& options) const {
    if (fixed_steps_ > 0) {
      const double k = static_cast<double>(statistics_.steps) + 1;
      return k >= fixed_steps_ ? t_end_ : t_start_ + direction_ * options.fixed_step * k;
    }
    const double left = std::abs(t_end_ - t_);
    if (1.01 * h_ >= left) return t_end_;
    return t_ + direction_ * (2 * h_ > left ? 0.5 * left : h_);
  }

  /// Whether the run continues.
  bool accept(double t_next, double error, const EnsembleOptions& options) {
    if (fixed_steps_ == 0) h_ = std::min(steps_.after_accepted(std::abs(t_next - t_), error), longest_step(options));
    t_ = t_next;
    ++statistics_.steps;
    return t_ != t_end_;
  }
  bool reject(double h, double error) {
    ++statistics_.rejected;
    h_ = steps_.after_rejected(std::abs(h), error);
    return h_ >= smallest_step(t_) || end(Outcome::step_too_small);
  }
  bool retry(int code) {
    ++statistics_.rejected;
    const bool adaptive = fixed_steps_ == 0;
    h_ = steps_.after_failed(adaptive ? std::min(h_, std::abs(t_end_ - t_)) : 0);
    return (adaptive && h_ >= smallest_step(t_)) || end(outcome_of_abi_code(code));
  }
  bool end(Outcome outcome) {
    outcome_ = outcome;
    return false;
  }

 private:
  static double smallest_step(double t) {
    const double magnitude = std::abs(t);
    return smallest_step_in_ulps * (std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude);
  }

  std::size_t member_;
  double t_start_, t_, t_end_, direction_;
  double h_ = 0, fixed_steps_ = 0;
  Steps steps_;
  Statistics statistics_;
  Outcome outcome_ = Outcome::done;
};

}  // namespace eom::ensemble
