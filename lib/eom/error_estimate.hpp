// SPDX-License-Identifier: MIT
// Error estimate of the end state of a run. In: the run and its options. Out: an estimate per component, from repeated
// runs.
//
// The second run is tighter: a hundredth of the tolerances, for order 5 a 25th (rtol not below 1e-14, and at most a
// half of it), or half the fixed step. If the error is proportional to the tolerance (or to step^order), the difference
// of the end states is the error of the first run times 1 - ratio (1 - 2^-order), and is divided by this factor. If the
// two runs agree so well that rounding or chance may explain it, a third run with another sequence of steps follows,
// and the largest difference counts. Fixed steps are not controlled, so the third run is always made. If it differs
// from the second by half as much as the second from the first, the steps are too long for the order to show and no
// difference is reliable. The estimate is at least a unit in the last place of the component. It excludes errors that
// all runs share: the model, t0, x0, the representation of the parameters, a discontinuity that no step detects.
//
// Near rounding a tighter run may need many times the steps, most of them rejected. With EstimateCost::bounded the
// repeated runs of chosen steps take about three times the steps of the run. If the tighter run needs more, a run at
// ten times the tolerances replaces it; its error exceeds that of the run by at least the factor 5.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "eom/ode.hpp"

namespace eom {

/// Estimated error of the end of a run, from repeated runs.
struct ErrorEstimate {
  std::vector<double> x;            // per component of the end state, absolute; infinite if a repeated run failed
  double max = 0;                   // the largest of them
  Outcome outcome = Outcome::done;  // the first outcome of a repeated run that differs from that of the run itself
  bool has_same_outcome = true;     // false: a compared run ended with another outcome than the run itself
  bool converging = true;           // false: shorter fixed steps change the end by as much again
  bool is_by_looser_run = false;    // the tighter run was too expensive
  std::size_t runs = 0;             // number of repeated runs
  Statistics statistics;            // cost of the repeated runs
};

namespace detail {

/// Options of a repeated run, and its expected error as a fraction of the first run's.
struct Repetition {
  Options options;
  double remaining;
};

/// Fixed steps that are shorter. span: the time that the run covered in `steps` steps.
inline Repetition shorter_steps(const Options& first, double span, std::size_t steps, int order, double part) {
  Repetition next{first, std::pow(part, order)};
  const double longest = steps > 0 ? std::min(first.fixed_step, span / static_cast<double>(steps)) : first.fixed_step;
  next.options.fixed_step = part * longest;
  // Without this, an event within the first step would be reached by the same single step in each run.
  next.options.event_parts = static_cast<std::size_t>(std::ceil(static_cast<double>(first.event_parts) / part));
  return next;
}

/// Tighter tolerances, with another sequence of steps: about 1.9 times as many for part = 0.5.
inline Repetition tighter(const Options& first, double span, std::size_t steps, int order, double part) {
  constexpr double smallest_rtol = 1e-14;
  const double floor = first.rtol > 0 ? smallest_rtol / first.rtol : 0;
  const double ratio = std::min(part, std::max(2 * part * std::max(0.01, std::pow(1.9, -order)), floor));
  Repetition next{first, ratio};
  next.options.rtol = first.rtol * ratio;
  next.options.atol = first.atol * ratio;
  next.options.initial_step = 0;
  // Steps limited by max_step or by their growth (few steps, or few between restarts) would repeat exactly.
  next.options.max_step = part * first.max_step;
  if (span > 0)
    next.options.max_step = std::min(next.options.max_step, span / (static_cast<double>(steps) + 1.5 / part));
  return next;
}

/// Looser tolerances. Steps that max_step limits are longer too, as they would repeat otherwise.
inline Repetition looser(const Options& first, int order, double ratio) {
  constexpr double proportionality = 0.7;  // error ~ tolerance^0.7 at least
  Repetition next{first, std::pow(ratio, proportionality)};
  next.options.rtol = first.rtol * ratio;
  next.options.atol = first.atol * ratio;
  next.options.initial_step = 0;
  next.options.max_step = first.max_step * std::pow(ratio, 1.0 / order);
  return next;
}

/// Bounds on the steps of repeated runs, accepted and rejected, for a run of `count` steps.
struct StepBudget {
  static constexpr double tighter_run = 2.4, all_runs = 3, at_most = 10;
  static constexpr std::size_t few = 30;  // these cost nothing

  std::size_t count;
  std::size_t steps(double times) const { return static_cast<std::size_t>(times * static_cast<double>(count)) + few; }
};

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

namespace detail {

/// The repeated runs of one estimate. run(options) -> Result.
template <class Run>
class Repetitions {
 public:
  Repetitions(int order, double t0, const Result& first, const Options& options, EstimateCost cost, Run& run)
      : order_(order),
        span_(std::abs(first.t - t0)),
        first_(first),
        options_(options),
        bounded_(cost == EstimateCost::bounded),
        run_(run) {
    estimate_.x.resize(first.x.size());
    for (std::size_t i = 0; i < first.x.size(); ++i) {
      estimate_.x[i] = std::numeric_limits<double>::epsilon() * std::abs(first.x[i]);
      size_ = std::max(size_, std::abs(first.x[i]));
    }
  }

  ErrorEstimate estimate() {
    options_.fixed_step > 0 ? repeat_fixed_steps() : repeat_chosen_steps();
    return std::move(estimate_);
  }

 private:
  Result repeat(const Options& options) {
    Result again = run_(options);
    ++estimate_.runs;
    estimate_.statistics += again.statistics;
    return again;
  }

  bool is_comparable(const Result& again) const {
    return again.outcome == Outcome::done || again.outcome == first_.outcome;
  }

  /// Whether a component may differ from rounding or by chance only.
  bool is_small() const { return estimate_.max <= rounding_suspected * size_; }

  bool compare(const Result& again, double remaining) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool comparable = is_comparable(again);
    if (!comparable) estimate_.outcome = again.outcome;
    estimate_.has_same_outcome = estimate_.has_same_outcome && again.outcome == first_.outcome;
    for (std::size_t i = 0; i < first_.x.size(); ++i) {
      const double difference = comparable ? std::abs(first_.x[i] - again.x[i]) / std::abs(1 - remaining) : infinity;
      estimate_.x[i] = std::max(estimate_.x[i], std::isnan(difference) ? infinity : difference);
      estimate_.max = std::max(estimate_.max, estimate_.x[i]);
    }
    return comparable;
  }

  void repeat_fixed_steps() {
    const auto shorter = [&](double part) {
      return shorter_steps(options_, span_, first_.statistics.steps, order_, part);
    };
    const Repetition half = shorter(0.5), third = shorter(0.35);
    const Result second = repeat(half.options);
    if (!compare(second, half.remaining)) return;
    const Result again = repeat(third.options);
    if (!compare(again, third.remaining)) return;
    double before = 0, after = 0;
    for (std::size_t i = 0; i < first_.x.size(); ++i) {
      before = std::max(before, std::abs(first_.x[i] - second.x[i]));
      after = std::max(after, std::abs(second.x[i] - again.x[i]));
    }
    if (after > std::max(still_converging * before, rounding_suspected * size_)) estimate_.converging = false;
  }

  void repeat_chosen_steps() {
    const StepBudget budget{first_.statistics.steps + first_.statistics.rejected};
    const Repetition second = tighter(options_, span_, first_.statistics.steps, order_, 0.5);
    std::optional<Result> again = within(second.options, budget.steps(StepBudget::tighter_run));
    if (!again) return compare_with_looser_run(second, budget);
    if (!compare(*again, second.remaining) || !is_small()) return;
    // The third run takes somewhat more steps than the second.
    const std::size_t used = again->statistics.steps + again->statistics.rejected;
    const bool affordable =
        !bounded_ || used + used + used / 10 <= budget.steps(StepBudget::all_runs) + StepBudget::few;
    const Repetition third =
        affordable ? tighter(options_, span_, first_.statistics.steps, order_, 0.35) : looser_run(4);
    const Result other = repeat(third.options);
    if (affordable || other.outcome == first_.outcome) compare(other, third.remaining);
  }

  /// The run with these options, unless it needs more steps.
  std::optional<Result> within(Options options, std::size_t steps) {
    const bool binding = bounded_ && steps < options.max_steps;
    if (binding) options.max_steps = steps;
    Result again = repeat(options);
    if (binding && again.outcome == Outcome::max_steps && first_.outcome != Outcome::max_steps) return std::nullopt;
    return again;
  }

  /// A looser run needs fewer steps. One that takes twice as many is lost in a singular motion.
  Repetition looser_run(double ratio) const {
    Repetition result = looser(options_, order_, ratio);
    const std::size_t steps = 2 * (first_.statistics.steps + first_.statistics.rejected) + StepBudget::few;
    if (bounded_) result.options.max_steps = std::min(result.options.max_steps, steps);
    return result;
  }

  void compare_with_looser_run(const Repetition& second, const StepBudget& budget) {
    const Repetition loose = looser_run(10);
    if (const Result again = repeat(loose.options); again.outcome == first_.outcome) {
      compare(again, loose.remaining);
      estimate_.is_by_looser_run = true;
      return;
    }
    Options options = second.options;
    options.max_steps = std::min(options.max_steps, budget.steps(StepBudget::at_most - StepBudget::all_runs));
    compare(repeat(options), second.remaining);
  }

  int order_;
  double span_, size_ = 0;
  const Result& first_;
  const Options& options_;
  bool bounded_;
  Run& run_;
  ErrorEstimate estimate_;
};

}  // namespace detail

/// Estimates the error of a run that may consist of several integrate() calls (restarts at events, modes). run(options)
/// -> Result repeats it from t0 on. order: of the method; of chosen steps only the length of looser ones depends on it.
template <class Run>
ErrorEstimate estimate_error(int order, double t0, const Result& first, const Options& options, Run&& run,
                             EstimateCost cost = EstimateCost::bounded) {
  return detail::Repetitions<std::remove_reference_t<Run>>(order, t0, first, options, cost, run).estimate();
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
