// SPDX-License-Identifier: MIT
// Error estimate of the end state of a run. In: the run and its options. Out: an estimate per component, from repeated
// runs.
//
// The second run is tighter: a hundredth of the tolerances (rtol not below 1e-14, and at most a half of it), or half
// the fixed step. If the error is proportional to the tolerance (or to step^order), the difference of the end states is
// the error of the first run times 1 - ratio (1 - 2^-order), and is divided by this factor. If the two runs agree so
// well that rounding or chance may explain it, a third run with another sequence of steps follows, and the largest
// difference counts. Fixed steps are not controlled, so the third run is always made. If it differs from the second by
// half as much as the second from the first, the steps are too long for the order to show and no difference is
// reliable. The estimate is at least a unit in the last place of the component. It excludes errors that all runs
// share: the model, t0, x0, the representation of the parameters, a discontinuity that no step detects.
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
  std::vector<double> x;            // per component of the end state, absolute; infinite if a repeated run failed
  double max = 0;                   // the largest of them
  Outcome outcome = Outcome::done;  // the first outcome of a repeated run that differs from that of the run itself
  bool converging = true;           // false: shorter fixed steps change the end by as much again
  std::size_t runs = 0;             // number of repeated runs
  Statistics statistics;            // cost of the repeated runs
};

namespace detail {

/// Options of a repeated run, and the fraction of the first run's error that is expected to remain in it.
struct Repetition {
  Options options;
  double remaining;
};

/// Options that repeat the run with another sequence of steps. span: the time that the run covered in `steps` steps.
inline Repetition repetition(const Options& first, double span, std::size_t steps, int order, double part) {
  Repetition next{first, 0};
  const double count = static_cast<double>(steps);
  if (first.fixed_step > 0) {
    next.options.fixed_step = part * (steps > 0 ? std::min(first.fixed_step, span / count) : first.fixed_step);
    // Without this, an event within the first step would be reached by the same single step in each run.
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
  // Steps limited by max_step or by their growth (few steps, or few between restarts) would repeat exactly.
  next.options.max_step = part * first.max_step;
  if (span > 0) next.options.max_step = std::min(next.options.max_step, span / (count + 1.5 / part));
  next.remaining = ratio;
  return next;
}

/// Largest change by the 0.35 step, relative to the change by the half step, that counts as convergence. Order 1 gives
/// 0.3.
inline constexpr double still_converging = 0.5;

/// Differences below this fraction of the largest component may be rounding and require a third run.
inline constexpr double rounding_suspected = 1e-10;

inline int order_of(std::string_view method) {
  if (const MethodInfo* info = find_method(method)) return info->order;
  throw_unknown(method);
}

}  // namespace detail

/// Estimates the error of a run that may consist of several integrate() calls (restarts at events, modes). run(options)
/// -> Result repeats it from t0 on. order: of the method; only relevant for fixed steps.
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

/// Estimates the error of integrate(method, rhs, t0, x0, t1, options, ...) with result `first`, at the time it reached.
template <class F, class AfterStep = NoProjection>
ErrorEstimate estimate_error(std::string_view method, F&& rhs, double t0, std::span<const double> x0,
                             const Result& first, const Options& options, AfterStep&& after_step = {}) {
  return estimate_error(detail::order_of(method), t0, first, options, [&](const Options& tighter) {
    return integrate(method, rhs, t0, x0, first.t, tighter, NoObserver{}, after_step);
  });
}

}  // namespace eom
