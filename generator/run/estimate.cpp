// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <eom/error_estimate.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "run/integration.hpp"
#include "run/kicks.hpp"
#include "run/rounding.hpp"

namespace eomgen::run {
namespace {

using Stopwatch = std::chrono::steady_clock;

constexpr double worth_a_note = 1e-3;  // of a velocity

/// Whole turns between two runs are no difference where the angles were read off another chart.
void align(const RunRequest& request, const std::vector<double>& first, std::vector<double>& other) {
  constexpr double turn = 2 * std::numbers::pi;
  for (const ExchangedChart& chart : request.charts) {
    for (const std::size_t angle : chart.angles)
      other[angle] += turn * std::round((first[angle] - other[angle]) / turn);
  }
}

/// Where fixed steps do not resolve the motion the ends say little: the differences on the way are the estimate then.
void tell_unresolved(const Resolution& resolution, RunResult& result) {
  if (!(resolution.largest() > Resolution::unresolved)) return;
  double& all = result.error_estimate.back().second;
  for (std::size_t i = 0; i < resolution.differences().size() && i + 1 < result.error_estimate.size(); ++i) {
    double& estimate = result.error_estimate[i].second;
    estimate = std::max(estimate, resolution.differences()[i]);
    all = std::max(all, estimate);
  }
  if (!result.estimate_note.empty()) return;
  result.estimate_note = fmt::format(
      "steps of this size do not resolve the motion: halving them moves states on the way by {:.2g} of their size; "
      "take shorter ones, or a solver "
      "that chooses its steps",
      resolution.largest());
}

/// Of fixed steps: what the last digits of the start do to the end.
void see_rounding(const RunRequest& request, const std::string& solver, const eom::Result& first, eom::Options options,
                  eom::ErrorEstimate& estimate, RunResult& result) {
  eom::Result other = from_rounded_start(request, solver, options);
  ++estimate.runs;
  estimate.statistics += other.statistics;
  if (other.outcome != first.outcome) {
    result.estimate_note = fmt::format(
        "from a start that differs in its last digits the run ends with '{}'; the estimate is not to be trusted",
        eom::name(other.outcome));
    return;
  }
  align(request, first.x, other.x);
  for (std::size_t i = 0; i < first.x.size(); ++i) {
    const double difference = std::abs(first.x[i] - other.x[i]);
    estimate.x[i] =
        std::max(estimate.x[i], std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference);
  }
}

void see_rounding_of_rates(const RunRequest& request, const eom::Result& first, eom::ErrorEstimate& estimate) {
  const std::vector<double> rates = rounding_of_rates(request, first.t, first.x);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    double& of = estimate.x[request.code.free.size() + i];
    of = std::max(of, rates[i]);
  }
}

/// Steps so short that positions move in their last digits only: constraints on positions are then met by rounding, and
/// rates follow from that.
void tell_frozen(const RunRequest& request, const eom::Result& first, const eom::Options& options, RunResult& result) {
  constexpr double digits = 100 * std::numeric_limits<double>::epsilon();
  const std::size_t n = request.code.free.size();
  double position = 0, rate = 0;
  for (std::size_t i = 0; i < n; ++i) {
    position = std::max(position, std::abs(first.x[i]));
    rate = std::max(rate, std::abs(first.x[n + i]));
  }
  if (request.code.active_constraints == 0 || !(rate > 0) || options.fixed_step * rate >= digits * position ||
      !result.estimate_note.empty())
    return;
  result.estimate_note = fmt::format(
      "steps of {:.3g} move the positions by less than their last digits, so that the constraints say nothing about "
      "rates; the estimate is not to be trusted",
      options.fixed_step);
}

/// Where a force turns within one step, what it changes the velocity by in the wrong place is in the end, and not in
/// the differences of ends.
void tell_kick(const Kicks& kicks, std::span<const double> end, RunResult& result) {
  double at = 0;
  const double part = 2 * kicks.largest(at);  // seen in steps of half the size
  if (!(part > 0)) return;
  double& all = result.error_estimate.back().second;
  for (std::size_t i = 0; i < end.size() && i + 1 < result.error_estimate.size(); ++i) {
    double& estimate = result.error_estimate[i].second;
    estimate = std::max(estimate, part * std::abs(end[i]));
    all = std::max(all, estimate);
  }
  if (!result.estimate_note.empty() || part < worth_a_note) return;
  result.estimate_note = fmt::format(
      "near t = {:.6g} a force turns within one step, which changes the velocity by up to {:.2g} of its size in the "
      "wrong place; take shorter steps, or a "
      "solver that chooses its steps",
      at, part);
}

}  // namespace

void estimate_error(const RunRequest& request, const std::string& solver, const eom::Result& first,
                    const eom::Options& options, Resolution* resolution, RunResult& result) {
  const Stopwatch::time_point start = Stopwatch::now();
  const int order = method_named(solver).order;
  Integration again(request, solver);
  Kicks kicks(request.code.free.size(), request.code.free.size());
  bool same_end = true, compared = false;
  double stop = std::numeric_limits<double>::epsilon() * std::abs(first.t);
  eom::ErrorEstimate estimate =
      eom::estimate_error(order, request.scene.t0, first, options, [&](const eom::Options& tighter) {
        const Integration::Observer compare = [&](const eom::StepView& step) {
          if (again.charts().second() != 0) return true;
          resolution->compare(step, [&](const auto& one, auto& two) { align(request, one, two); });
          kicks.see(step, [&](double t, const double* x, double* dx) { return again.derivative(t, x, dx); });
          return true;
        };
        const bool on_the_way = resolution != nullptr && !std::exchange(compared, true);
        eom::Result other = again.run(tighter, on_the_way ? compare : Integration::Observer{});
        if (other.outcome == first.outcome) {
          other.x = again.own_state(other);
          align(request, first.x, other.x);
        }
        same_end = same_end && other.outcome == first.outcome;
        stop = std::max(stop, std::abs(other.t - first.t));
        return other;
      });
  if (resolution != nullptr) see_rounding(request, solver, first, options, estimate, result);
  if (method_named(solver).variational) see_rounding_of_rates(request, first, estimate);
  double largest = 0;
  for (std::size_t i = 0; i < request.state_names.size(); ++i) {
    result.error_estimate.emplace_back(request.state_names[i], estimate.x[i]);
    largest = std::max(largest, estimate.x[i]);
  }
  if (first.outcome == eom::Outcome::stopped_by_event) result.error_estimate.emplace_back("t", stop);
  result.error_estimate.emplace_back("max", largest);
  result.estimate_rhs_evaluations = estimate.statistics.rhs_evaluations + kicks.evaluations();
  if (estimate.outcome != eom::Outcome::done) {
    result.estimate_note =
        fmt::format("a tighter run ended with '{}'; the estimate is not to be trusted", eom::name(estimate.outcome));
  }
  if (!same_end && result.estimate_note.empty()) {
    result.estimate_note =
        "a tighter run did not stop at the event: the ends that are compared are not of the same time";
  }
  if (resolution != nullptr) tell_unresolved(*resolution, result);
  kicks.finish();
  tell_kick(kicks, first.x, result);
  if (!estimate.converging && result.estimate_note.empty()) {
    result.estimate_note =
        "steps of this size are too long for the method's order to show: shorter ones change the end by as much again; "
        "the estimate is not to be trusted";
  }
  if (method_named(solver).variational) tell_frozen(request, first, options, result);
  result.seconds_estimate = std::chrono::duration<double>(Stopwatch::now() - start).count();
}

}  // namespace eomgen::run
