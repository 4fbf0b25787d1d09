// SPDX-License-Identifier: MIT
// How far off the end state of a run is. In: the run and its options. Out: an estimate per component, from further
// runs.
//
// The second run is tighter: tolerances a hundredth, not below rtol 1e-14, but at most a half; or half the fixed step.
// With the error proportional to the tolerance (to step^order) the difference of the end states is the first run's
// error times 1 - ratio (1 - 2^-order), by which it is divided. Where the two agree so well that rounding may be what
// they differ by, or happen to agree in, a third run with another sequence of steps is made and the largest difference
// is taken. Of fixed steps, which nothing controls, the third run is always made: where it differs from the second by
// half as much as that one from the first the steps are too long for the order to show, and no difference says much.
// Never below a unit in the last place of the component. What all runs get wrong alike (the model, t0, x0, the
// representation of the parameters, a discontinuity that no step sees) is not in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "eom/ode.hpp"

namespace eom {

struct ErrorEstimate {
  std::vector<double> x;            // per component of the end state, absolute; infinite where a further run failed
  double max = 0;                   // the largest of them
  Outcome outcome = Outcome::done;  // of the further runs: the first that did not end as the run itself did
  bool converging = true;           // false: shorter fixed steps change the end by as much again
  std::size_t runs = 0;             // further runs made
  Statistics statistics;            // and what they cost
};

namespace detail {

/// A further run's options and the fraction of the first run's error that is expected to remain in it.
struct Repetition {
  Options options;
  double remaining;
};

/// The run made anew with another sequence of steps: span is the time it covered in so many steps.
inline Repetition repetition(const Options& first, double span, std::size_t steps, int order, double part) {
  Repetition next{first, 0};
  const double count = static_cast<double>(steps);
  if (first.fixed_step > 0) {
    next.options.fixed_step = part * (steps > 0 ? std::min(first.fixed_step, span / count) : first.fixed_step);
    // The way to an event that is shorter than all these steps would be the same step in each run.
    next.options.event_parts = static_cast<std::size_t>(std::ceil(static_cast<double>(first.event_parts) / part));
    next.remaining = std::pow(part, order);
    return next;
  }
  constexpr double smallest_rtol = 1e-14;
  const double floor = first.rtol > 0 ? smallest_rtol / first.rtol : 0;
  const double ratio = std::min(part, std::max(part / 50, floor));
  next.options.rtol = first.rtol * ratio;
  next.options.atol = first.atol * ratio;
  next.options.initial_step = 0;
  // Steps bounded by max_step or by their growth (few, or few between restarts) would repeat themselves exactly.
  next.options.max_step = part * first.max_step;
  if (span > 0) next.options.max_step = std::min(next.options.max_step, span / (count + 1.5 / part));
  next.remaining = ratio;
  return next;
}

/// Of the change that half the step makes, what 0.35 of it may add; 0.3 is what order 1 does.
inline constexpr double still_converging = 0.5;

/// What counts as close enough to rounding for a third run: relative to the largest component.
inline constexpr double rounding_suspected = 1e-10;

inline int order_of(std::string_view method) {
  if (const MethodInfo* info = find_method(method)) return info->order;
  throw_unknown(method);
}

}  // namespace detail

/// The estimate for a run that may be more than one integrate() (restarts at events, modes): run(options) -> Result
/// repeats it, from t0 on. order: the method's; it matters for fixed steps only.
template <class Run>
ErrorEstimate estimate_error(int order, double t0, const Result& first, const Options& options, Run&& run) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ErrorEstimate estimate;
  estimate.x.resize(first.x.size());
  double size_x = 0;
  for (std::size_t i = 0; i < first.x.size(); ++i) {
    estimate.x[i] = std::numeric_limits<double>::epsilon() * std::abs(first.x[i]);
    size_x = std::max(size_x, std::abs(first.x[i]));
  }
  std::vector<double> second;
  const bool fixed = options.fixed_step > 0;
  for (const double part : {0.5, 0.35}) {
    const detail::Repetition next =
        detail::repetition(options, std::abs(first.t - t0), first.statistics.steps, order, part);
    const Result again = run(next.options);
    ++estimate.runs;
    estimate.statistics += again.statistics;
    const bool comparable = again.outcome == Outcome::done || again.outcome == first.outcome;
    if (!comparable) estimate.outcome = again.outcome;
    for (std::size_t i = 0; i < first.x.size(); ++i) {
      const double difference = comparable ? std::abs(first.x[i] - again.x[i]) / (1 - next.remaining) : infinity;
      estimate.x[i] = std::max(estimate.x[i], std::isnan(difference) ? infinity : difference);
      estimate.max = std::max(estimate.max, estimate.x[i]);
    }
    if (!comparable) break;
    if (!fixed && estimate.max > detail::rounding_suspected * size_x) break;
    if (second.empty()) {
      second = again.x;
      continue;
    }
    double before = 0, after = 0;
    for (std::size_t i = 0; i < first.x.size(); ++i) {
      before = std::max(before, std::abs(first.x[i] - second[i]));
      after = std::max(after, std::abs(second[i] - again.x[i]));
    }
    if (fixed && after > std::max(detail::still_converging * before, detail::rounding_suspected * size_x))
      estimate.converging = false;
  }
  return estimate;
}

/// The same for a run that starts at t = 0.
template <class Run>
ErrorEstimate estimate_error(int order, const Result& first, const Options& options, Run&& run) {
  return estimate_error(order, 0.0, first, options, std::forward<Run>(run));
}

/// The estimate for a run of integrate(method, rhs, t0, x0, t1, options, ...) that gave `first`, at the time it
/// reached.
template <class F, class AfterStep = NoProjection>
ErrorEstimate estimate_error(std::string_view method, F&& rhs, double t0, std::span<const double> x0,
                             const Result& first, const Options& options, AfterStep&& after_step = {}) {
  return estimate_error(detail::order_of(method), t0, first, options, [&](const Options& tighter) {
    return integrate(method, rhs, t0, x0, first.t, tighter, NoObserver{}, after_step);
  });
}

}  // namespace eom
