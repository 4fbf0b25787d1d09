// SPDX-License-Identifier: MIT
// What goes into a run and what comes out of it: options, statistics, result, the view of one accepted step.
// No method is known here; every family of methods (explicit_rk/, ...) shares these types.
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

/// dx = f(t, x), returning a code of the C ABI (0: fine). The convenience form; integrate() takes any such callable.
using Rhs = std::function<int(double t, const double* x, double* dx)>;

/// Why `auto` changes its method.
enum class ChangeReason : std::uint8_t {
  beyond_stability,  // |h lambda| was beyond the limit of stability: stiff
  beyond_accuracy,   // |h lambda| was above what a motion that fast would allow for its accuracy: stiff
  vibrations,        // |h lambda| was near the limit of stability along vibrations
  no_longer_stiff    // h rho(df/dx) was low
};

/// One change of method by `auto`.
struct MethodChange {
  double t;
  const char *from, *to;
  ChangeReason why;
  double limit;  // of |h lambda|, or of h rho(df/dx)
  int steps;     // so many were beyond it
};

/// Why, as a clause.
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
  }
  return "";
}

/// What `auto` (automatic.hpp) integrates with, and how it came to that.
struct Choice {
  static constexpr int least_patience = 15;
  const char* method = nullptr;   // null: not chosen yet
  int patience = least_patience;  // so many stiff steps are asked for before the next change
  std::vector<MethodChange> changes;
};

/// From t on, until the next bound, no chosen step is to be longer than `step`, wherever in it that lies.
struct StepBound {
  double t, step;
};

/// One accepted step with its dense output; valid only during the call that shows it.
struct StepView {
  double t0, t1;
  std::span<const double> x0, x1;
  const void* interpolant = nullptr;  // the stepper, seen by evaluate only
  void (*evaluate)(const void* interpolant, double t, double* x) = nullptr;

  /// The state at t between t0 and t1 (x: as long as x0), by the method's dense output.
  void interpolate(double t, std::span<double> x) const { evaluate(interpolant, t, x.data()); }
};

struct Options {
  double rtol = 1e-9;  // error allowed per step and component: atol + rtol |x|
  double atol = 1e-12;
  double initial_step = 0;  // 0: chosen
  double max_step = std::numeric_limits<double>::infinity();
  std::span<const StepBound> step_bounds =
      {};  // ascending in t, of chosen steps that go forward in time: what is known to happen there is not stepped over
  /// Of a step whose error is within the tolerances: the longest that may be taken in its place, infinity where it may
  /// be taken. For what lies between the places at which a method sees the equations. Of fixed steps it is asked, and
  /// not heeded.
  std::function<double(const StepView&)> admit = {};
  double fixed_step = 0;        // > 0: steps of this size without error control, whatever the method; rk4 needs it
  std::size_t event_parts = 1;  // so many equal steps to a breaking event that ends a step, instead of one
  int series_order = 0;         // of `taylor`, and of `radau` (5, 9, 13); 0: chosen, and changed from step to step
  std::size_t max_steps = 50'000'000;            // accepted and rejected together
  std::size_t quadratures = 0;                   // trailing components of x kept out of the error norm
  const std::atomic<bool>* interrupt = nullptr;  // looked at once per step
  Choice* choice = nullptr;                      // of `auto`: written, and what the next run begins with
};

struct Statistics {
  std::size_t steps = 0;  // accepted
  std::size_t rejected = 0;
  std::size_t rhs_evaluations = 0;
  std::size_t dense_fallbacks = 0;  // steps whose dense output fell back to the cubic, since an added stage failed
  // of implicit methods
  std::size_t jacobians = 0;               // df/dx evaluated, by the right-hand side's own function or by differences
  std::size_t difference_evaluations = 0;  // of rhs_evaluations: for differences; 0 where the function was given
  std::size_t factorisations = 0;          // of the matrices of the implicit step
  std::size_t newton_iterations = 0;
  std::size_t newton_failures = 0;  // iterations given up; the step is then tried with a new df/dx or made shorter

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
};

struct Result {
  Outcome outcome = Outcome::done;
  double t = 0;           // the time reached: t1 exactly when the outcome is done
  std::vector<double> x;  // the state at t, the last accepted one
  Statistics statistics;
  std::string detail;  // one sentence when the outcome is not done, else empty
};

/// What the registry tells of a method. The dense output's error within one step is O(h^(dense_order + 1)).
struct MethodInfo {
  const char* name;
  int order;
  int dense_order;
  bool adaptive;          // false: needs Options::fixed_step
  Needs needs = {};       // of a system (features.hpp)
  bool ensemble = false;  // integrate_ensemble takes it too
};

/// The observer that looks at nothing.
struct NoObserver {
  bool operator()(const StepView&) const { return true; }
};

/// The after_step that moves nothing.
struct NoProjection {
  int operator()(double, double*) const { return 0; }
};

/// A run has diverged when a component of the state leaves this bound: far beyond mechanics, and squares still fit.
inline constexpr double divergence_bound = 1e150;

/// Steps shorter than this many units in the last place of t are refused (step_too_small).
inline constexpr double smallest_step_in_ulps = 16;

}  // namespace eom
