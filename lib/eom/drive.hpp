// SPDX-License-Identifier: MIT
// The run loop of one-step methods from t0 to t1. In: the method with its start, options, an observer and an
// after_step. Out: Result. The error estimate controls the steps, unless Options::fixed_step is set.
//
// A Method has the static members order, adaptive, error_uses_end and interpolate, and
//   size(), x0(), x1(), derivative0(), derivative1(), scratch()   its arrays
//   evaluate(t, x, dx), evaluate_start(t), evaluate_end()         the right-hand side, at x0, at x1; return codes
//   attempt(t0, t1)                                               a trial step; returns a code
//   error_norm(rtol, atol)                                        of the trial step: 1 is just allowed
//   after_accepted(h, error), after_rejected(h, error), after_failed(h)   the next step size
//   accept(moved)                                                 makes the end the next start
//   end_known(), starting_order()                                 replace error_uses_end and order if these vary
//   first_step()                                                  optional; default: from the derivatives at the start
//   statistics()                                                  except steps and rejected
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "eom/by_reference.hpp"
#include "eom/run_types.hpp"

namespace eom {

/// One run of a method: start, steps, end.
template <class Method, class Observer, class AfterStep>
class Run {
 public:
  template <class Problem>
  Run(Problem& problem, double t0, std::span<const double> x0, double t1, const Options& options, Observer& observer,
      AfterStep& after_step)
      : stepper_(problem, x0, options),
        options_(options),
        observer_(observer),
        after_step_(after_step),
        t_start_(t0),
        t_(t0),
        t_end_(t1),
        direction_(t1 < t0 ? -1.0 : 1.0) {}

  Result run() {
    if (t_ != t_end_ && start())
      while (t_ != t_end_ && step()) {
      }
    return result();
  }

 private:
  /// Computes the derivative and the step size at the start. False: the run ends here.
  bool start() {
    const int code = stepper_.evaluate_start(t_);
    if (code != 0)
      return end(outcome_of_abi_code(code),
                 (code == 1                 ? std::string("the mass matrix is singular")
                  : code == code_not_finite ? "an acceleration is not finite"
                                            : "the right-hand side returned code " + std::to_string(code)) +
                     " at the start");
    if (!all_finite(stepper_.x0()) || !all_finite(stepper_.derivative0()))
      return end(Outcome::not_finite, "the state or its derivative is not finite at the start");
    if (options_.fixed_step > 0) return plan_fixed_steps();
    h_ = options_.initial_step > 0 ? options_.initial_step : first_step();
    h_ = std::min(std::max(h_, smallest_step(t_)), longest_step());  // a shorter step is lost in the rounding of t
    return true;
  }

  /// The smallest sufficient number of equal steps. A quotient that is an integer up to rounding counts as one.
  bool plan_fixed_steps() {
    const double quotient = std::abs(t_end_ - t_start_) / options_.fixed_step;
    fixed_steps_ = std::max(1.0, std::ceil(quotient * (1 - 8 * epsilon)));
    if (fixed_steps_ > 1 && options_.fixed_step < smallest_step(std::max(std::abs(t_start_), std::abs(t_end_))))
      return end(Outcome::step_too_small, "the fixed step is lost in the rounding of t");
    return true;
  }

  /// Makes one trial step. False: the run ends here.
  bool step() {
    if (options_.interrupt != nullptr && options_.interrupt->load(std::memory_order_relaxed))
      return end(Outcome::interrupted, "stopped from outside");
    if (steps_ + rejected_ >= options_.max_steps)
      return end(Outcome::max_steps, "all " + std::to_string(options_.steps_before + options_.max_steps) +
                                         " steps of max_steps were made before t = " + printed(t_end_));
    const double t_next = next_time();
    bool moved = false;
    const int code = stepper_.attempt(t_, t_next);
    if (code != 0) return retry(code);
    const double error = adaptive() ? stepper_.error_norm(options_.rtol, options_.atol) : 0;
    if (!std::isfinite(error) || !all_finite(stepper_.x1())) return retry(code_not_finite);
    if (error > 1) return reject(t_next - t_, error);
    const int end_code = complete(t_next, moved);
    if (end_code != 0) return retry(end_code);
    if (options_.step_limit && !is_within_step_limit(t_next)) return true;
    return accept(t_next, error, moved);
  }

  StepView view(double t_next) {
    return {t_,
            t_next,
            {stepper_.x0(), stepper_.size()},
            {stepper_.x1(), stepper_.size()},
            &stepper_,
            &Method::interpolate,
            stepper_.derivative0(),
            stepper_.derivative1()};
  }

  /// Applies Options::step_limit. The smallest step is always accepted.
  bool is_within_step_limit(double t_next) {
    const double h = std::abs(t_next - t_), longest = options_.step_limit(view(t_next));
    if (!adaptive() || !(longest < h) || h <= smallest_step(t_)) return true;
    ++rejected_;
    h_ = std::max(longest, smallest_step(t_));
    return false;
  }

  bool end_known() const {
    if constexpr (requires { stepper_.end_known(); })
      return stepper_.end_known();
    else
      return Method::error_uses_end;
  }
  int starting_order() const {
    if constexpr (requires { stepper_.starting_order(); })
      return stepper_.starting_order();
    else
      return Method::order;
  }

  bool adaptive() const { return options_.fixed_step <= 0; }

  /// End of the next step. The last step ends exactly at t_end and may be stretched by 1 %. A remainder of at most two
  /// steps is halved, so that no sliver remains.
  double next_time() const {
    if (!adaptive()) {
      const double k = static_cast<double>(steps_) + 1;
      return k >= fixed_steps_ ? t_end_ : t_start_ + direction_ * options_.fixed_step * k;
    }
    const double left = std::abs(t_end_ - t_), h = options_.step_bounds.empty() ? h_ : bounded(h_);
    if (1.01 * h >= left) return t_end_;
    return t_ + direction_ * (2 * h > left ? 0.5 * left : h);
  }

  /// The longest step, at most h, that respects the bounds along it. It may end at the beginning of a bound.
  double bounded(double h) const {
    const auto bounds = options_.step_bounds;
    auto bound =
        std::upper_bound(bounds.begin(), bounds.end(), t_, [](double t, const StepBound& b) { return t < b.t; });
    if (bound != bounds.begin()) --bound;
    for (; bound != bounds.end() && bound->t < t_ + h; ++bound) {
      const double until = bound->t - t_;
      h = std::min(h, std::max({bound->step, until > smallest_step(t_) ? until : 0, smallest_step(t_)}));
    }
    return h;
  }

  /// Runs after_step and evaluates the derivative at the end of the step. Returns a code.
  int complete(double t_next, bool& moved) {
    if (!detail::is_none(after_step_)) {
      double* x1 = stepper_.x1();
      std::copy_n(x1, stepper_.size(), stepper_.scratch());
      const int code = after_step_(t_next, x1);
      if (code != 0) return code;
      moved = !std::equal(x1, x1 + stepper_.size(), stepper_.scratch());
      if (moved && !all_finite(x1)) return code_not_finite;
    }
    if (moved || !end_known()) {
      const int code = stepper_.evaluate_end();
      if (code != 0) return code;
    }
    return all_finite(stepper_.derivative1()) ? 0 : code_not_finite;
  }

  bool accept(double t_next, double error, bool moved) {
    const bool continues = observer_(view(t_next));
    if (adaptive()) h_ = std::min(stepper_.after_accepted(std::abs(t_next - t_), error), longest_step());
    t_ = t_next;
    stepper_.accept(moved);
    ++steps_;
    if (!continues) return end(Outcome::stopped_by_event, "stopped by the observer at t = " + printed(t_));
    if (adaptive() && (steps_ & (steps_ - 1)) == 0 && stagnates())
      return end(Outcome::step_too_small,
                 "the steps become ever shorter before t = " + printed(t_) + ", as at a singularity of the equations");
    const double* x = stepper_.x0();
    if (std::any_of(x, x + stepper_.size(), [](double value) { return std::abs(value) > divergence_bound; }))
      return end(Outcome::diverged, "a component of the state exceeds 1e150 at t = " + printed(t_));
    return true;
  }

  /// Whether a run comes ever nearer to a time that it does not reach, by steps that shrink slower than their distance
  /// from it. Called at each doubling of the number of steps: the mean step has halved at each of the last ones, and
  /// the rest would take too many.
  bool stagnates() {
    constexpr std::size_t first = 1024;
    constexpr int most_halvings = 4;
    constexpr double most_steps = 1e8;
    if (steps_ < first) {
      doubled_at_ = t_;
      return false;
    }
    const double mean = std::abs(t_ - doubled_at_) / (0.5 * static_cast<double>(steps_));
    halvings_ = mean < 0.5 * mean_step_ ? halvings_ + 1 : 0;
    mean_step_ = mean;
    doubled_at_ = t_;
    return halvings_ >= most_halvings && std::abs(t_end_ - t_) > most_steps * mean;
  }

  bool reject(double h, double error) {
    ++rejected_;
    h_ = stepper_.after_rejected(std::abs(h), error);
    if (h_ >= smallest_step(t_)) return true;
    return end(Outcome::step_too_small,
               "the error estimate asks for a step below 16 units in the last place of t = " + printed(t_));
  }

  /// After a code or a value that is not finite: shortens the step, down to the smallest. A fixed step ends the run at
  /// once.
  bool retry(int code) {
    ++rejected_;
    h_ = stepper_.after_failed(adaptive() ? std::min(h_, std::abs(t_end_ - t_)) : 0);
    if (adaptive() && h_ >= smallest_step(t_)) return true;
    const std::string what = code == code_not_finite ? "a value that is not finite"
                             : code == code_no_convergence
                                 ? "the iteration of the implicit step does not converge, or its matrix is singular,"
                             : code == code_jump ? "the right-hand side jumps"
                                                 : "code " + std::to_string(code);
    return end(outcome_of_abi_code(code), what + " just after t = " + printed(t_));
  }

  double first_step() {
    if constexpr (requires { stepper_.first_step(); })
      return stepper_.first_step();
    else
      return initial_step();
  }

  /// Step size for which an Euler step, and the change of the derivative along it, are small (HNW I, section II.4).
  double initial_step() {
    const std::size_t n = stepper_.size() - options_.quadratures;
    const double* x = stepper_.x0();
    const double* f0 = stepper_.derivative0();
    const double size_x = norm(n, [&](std::size_t i) { return x[i]; });
    const double size_f = norm(n, [&](std::size_t i) { return f0[i]; });
    double h0 = size_x < 1e-5 || size_f < 1e-5 ? 1e-6 : 0.01 * size_x / size_f;
    h0 = std::min(h0, longest_step());
    double* x_euler = stepper_.x1();
    double* f1 = stepper_.scratch();
    for (std::size_t i = 0; i < stepper_.size(); ++i) x_euler[i] = x[i] + direction_ * h0 * f0[i];
    if (stepper_.evaluate(t_ + direction_ * h0, x_euler, f1) != 0 || !all_finite(f1)) return 0.01 * h0;
    const double size_change = norm(n, [&](std::size_t i) { return f1[i] - f0[i]; }) / h0;
    const double largest = std::max(size_f, size_change);
    const double h1 = largest <= 1e-15 ? std::max(1e-6, 1e-3 * h0) : std::pow(0.01 / largest, 1.0 / starting_order());
    return std::min(100 * h0, h1);
  }

  template <class Component>
  double norm(std::size_t n, Component component) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double scale = options_.atol + options_.rtol * std::abs(stepper_.x0()[i]);
      if (scale == 0) continue;  // atol is 0 and the component starts at 0: it has no scale yet
      const double value = component(i) / scale;
      sum += value * value;
    }
    return std::sqrt(sum / static_cast<double>(n));
  }

  double longest_step() const { return std::min(options_.max_step, std::abs(t_end_ - t_start_)); }

  static double smallest_step(double t) {
    const double magnitude = std::abs(t);
    return smallest_step_in_ulps * (std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude);
  }

  bool all_finite(const double* values) const {
    return std::all_of(values, values + stepper_.size(), [](double value) { return std::isfinite(value); });
  }

  static std::string printed(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }

  bool end(Outcome outcome, std::string detail) {
    outcome_ = outcome;
    detail_ = std::move(detail);
    return false;
  }

  Result result() {
    Statistics statistics = stepper_.statistics();
    statistics.steps = steps_;
    statistics.rejected = rejected_;
    return {outcome_,
            t_,
            {stepper_.x0(), stepper_.x0() + stepper_.size()},
            statistics,
            std::move(detail_),
            adaptive() ? h_ : 0.0};
  }

  static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  Method stepper_;
  const Options& options_;
  Observer& observer_;
  AfterStep& after_step_;
  double t_start_;
  double t_;
  double t_end_;
  double direction_;
  double h_ = 0;  // size of the next trial step
  double fixed_steps_ = 0;
  double doubled_at_ = 0, mean_step_ = 0;  // of stagnates()
  int halvings_ = 0;
  std::size_t steps_ = 0;
  std::size_t rejected_ = 0;
  Outcome outcome_ = Outcome::done;
  std::string detail_;
};

}  // namespace eom
