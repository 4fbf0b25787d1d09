// SPDX-License-Identifier: MIT
// Types shared by all families of methods (explicit_rk/, ...): options, statistics, the result of a run, the view of
// one accepted step.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "eom/features.hpp"
#include "eom/outcome.hpp"

namespace eom {

/// dx = f(t, x), returning a code of the C ABI (0: no error). This is the convenience form; integrate() takes any such
/// callable.
using Rhs = std::function<int(double t, const double* x, double* dx)>;

/// Reason for a change of method by `auto`.
enum class ChangeReason : std::uint8_t {
  beyond_stability,  // |h lambda| exceeded the stability limit: stiff
  beyond_accuracy,   // |h lambda| exceeded the value that accuracy would allow for so fast a motion: stiff
  vibrations,        // |h lambda| was near the stability limit along vibrations
  no_longer_stiff,   // h rho(df/dx) was low
  costlier           // the first steps of the implicit method cost more per unit of time
};

/// One change of method by `auto`.
struct MethodChange {
  double t;
  const char *from, *to;
  ChangeReason why;
  double limit;  // on |h lambda|, or on h rho(df/dx); for costlier: the ratio of the costs
  int steps;     // number of steps beyond the limit
};

/// The reason, as a clause.
inline std::string to_text(const MethodChange& change) {
  const auto text = [&change](const char* words, const char* method) {
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, words, change.limit, change.steps, method);
    return std::string(buffer);
  };
  switch (change.why) {
    case ChangeReason::beyond_stability:
      return text("|h lambda| was beyond %.1f in %d steps, the limit of stability of %s: stiff", change.from);
    case ChangeReason::beyond_accuracy:
      return text(
          "|h lambda| was above %.1f in %d steps in a row, which a motion that fast would not allow %s for its "
          "accuracy: stiff",
          change.from);
    case ChangeReason::vibrations:
      return text("|h lambda| was above %.1f in %d steps in a row, near the limit of stability of %s along vibrations",
                  change.from);
    case ChangeReason::no_longer_stiff:
      return text("h rho(df/dx) was below %.1f for %d steps in a row, which %s can take: no longer stiff", change.to);
    case ChangeReason::costlier:
      return text("it cost %.1f times as much per unit of time in %d steps as %s", change.to);
  }
  return "";
}

/// The method that `auto` (automatic.hpp) uses, its counts, which continue after events, and the history of its
/// changes.
struct MethodChoice {
  static constexpr int min_stiff_steps = 15;
  const char* method = nullptr;  // null: not chosen yet
  // Steps in a row that the next change requires: to the implicit method, and back.
  int required_stiff_steps = min_stiff_steps, required_nonstiff_steps = min_stiff_steps;
  int steps = 0;  // of the explicit method since the last change, or those that the implicit one replaced
  std::vector<MethodChange> changes;
};

/// Upper bound on chosen steps: from t to the next bound, no step that overlaps this interval is longer than `step`.
struct StepBound {
  double t, step;
};

/// Cost of an error estimate (error_estimate.hpp) of a run with chosen steps.
enum class EstimateCost : std::uint8_t {
  bounded,  // three times the steps of the run, ten if no looser run reaches the same end
  full      // as many steps as the tighter runs need
};

/// One accepted step with its dense output. Valid only during the call that receives it.
struct StepView {
  double t0, t1;
  std::span<const double> x0, x1;
  const void* interpolant = nullptr;  // the stepper; only `evaluate` uses it
  void (*evaluate)(const void* interpolant, double t, double* x) = nullptr;
  const double *derivative0 = nullptr, *derivative1 = nullptr;  // dx/dt at the ends; null: not available

  /// The state at t between t0 and t1 by the method's dense output. x is as long as x0.
  void interpolate(double t, std::span<double> x) const { evaluate(interpolant, t, x.data()); }
};

/// Options of integrate(). Times have the unit of t.
struct Options {
  double rtol = 1e-9;  // error allowed per step and component: atol + rtol |x|
  double atol = 1e-12;
  double initial_step = 0;  // 0: chosen
  double max_step = std::numeric_limits<double>::infinity();
  std::span<const StepBound> step_bounds =
      {};  // ascending in t, for chosen steps forward in time: keeps steps from skipping events known in advance
  /// Called for each step whose error is within the tolerances. Returns the longest step that may replace it, infinity
  /// if the step may be taken as it is. It covers features between the points at which a method evaluates the
  /// equations. For fixed steps the result is ignored.
  std::function<double(const StepView&)> step_limit = {};
  double fixed_step = 0;         // > 0: steps of this size without error control, for any method; required by rk4
  std::size_t event_parts = 1;   // number of equal steps up to a breaking event that ends a step
  std::size_t steps_before = 0;  // of the same run, before this part of it: for messages
  bool events_at_end = true;     // events at t1 belong to the run; false: to its continuation
  int series_order = 0;          // of `taylor`, and of `radau` (5, 9, 13); 0: chosen and adapted from step to step
  std::size_t max_steps = 50'000'000;            // accepted and rejected together
  std::size_t quadratures = 0;                   // trailing components of x that are excluded from the error norm
  const std::atomic<bool>* interrupt = nullptr;  // polled once per step
  MethodChoice* choice = nullptr;                // of `auto`: output, and the initial value for the next run
};

/// Counts of the work of a run.
struct Statistics {
  std::size_t steps = 0;  // accepted
  std::size_t rejected = 0;
  std::size_t rhs_evaluations = 0;
  std::size_t dense_fallbacks = 0;  // steps whose dense output fell back to the cubic because an added stage failed
  // implicit methods only
  std::size_t jacobians = 0;               // df/dx evaluated, by the right-hand side's own function or by differences
  std::size_t difference_evaluations = 0;  // part of rhs_evaluations used for differences; 0 if the function was given
  std::size_t factorisations = 0;          // of the matrices of the implicit step
  std::size_t newton_iterations = 0;
  std::size_t newton_failures = 0;  // failed iterations; the step is retried with a new df/dx or a shorter length

  Statistics& operator+=(const Statistics& other) {
    steps += other.steps;
    rejected += other.rejected;
    rhs_evaluations += other.rhs_evaluations;
    dense_fallbacks += other.dense_fallbacks;
    jacobians += other.jacobians;
    difference_evaluations += other.difference_evaluations;
    factorisations += other.factorisations;
    newton_iterations += other.newton_iterations;
    newton_failures += other.newton_failures;
    return *this;
  }
  /// Counts since an earlier state of the same counts.
  Statistics operator-(const Statistics& earlier) const {
    Statistics rest = *this;
    rest.steps -= earlier.steps;
    rest.rejected -= earlier.rejected;
    rest.rhs_evaluations -= earlier.rhs_evaluations;
    rest.dense_fallbacks -= earlier.dense_fallbacks;
    rest.jacobians -= earlier.jacobians;
    rest.difference_evaluations -= earlier.difference_evaluations;
    rest.factorisations -= earlier.factorisations;
    rest.newton_iterations -= earlier.newton_iterations;
    rest.newton_failures -= earlier.newton_failures;
    return rest;
  }
};

/// Result of integrate().
struct Result {
  Outcome outcome = Outcome::done;
  double t = 0;           // the time reached; exactly t1 if the outcome is done
  std::vector<double> x;  // the state at t, the last accepted one
  Statistics statistics;
  std::string detail;    // one sentence if the outcome is not done, else empty
  double next_step = 0;  // size of a step that would follow; 0 for fixed steps
};

/// Properties of a method in the registry. The dense output has an error of O(h^(dense_order + 1)) within one step.
struct MethodInfo {
  const char* name;
  int order;
  int dense_order;
  bool adaptive;          // false: needs Options::fixed_step
  Needs needs = {};       // requirements on a system (features.hpp)
  bool ensemble = false;  // supported by integrate_ensemble
};

/// An observer that does nothing.
struct NoObserver {
  bool operator()(const StepView&) const { return true; }
};

/// An after_step that does not change the state.
struct NoProjection {
  int operator()(double, double*) const { return 0; }
};

/// A run has diverged if a component of the state exceeds this bound. It is far beyond mechanics, and squares do not
/// overflow.
inline constexpr double divergence_bound = 1e150;

/// Steps shorter than this many units in the last place of t are refused (step_too_small).
inline constexpr double smallest_step_in_ulps = 16;

}  // namespace eom
