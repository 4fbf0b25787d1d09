// SPDX-License-Identifier: MIT
// Error estimate of the end of a run: repeated runs, and checks for errors of fixed steps that repetition does not
// show.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "eom/error_estimate.hpp"
#include "eom/hybrid/integration.hpp"
#include "eom/hybrid/rounding.hpp"
#include "eom/hybrid/run_result.hpp"
#include "eom/hybrid/step_adequacy.hpp"
#include "eom/hybrid/unresolved_impulses.hpp"

namespace eom::hybrid {

class EndErrorEstimator {
 public:
  /// order: of the method that ended the run; first: the run, in the model's own charts; adequacy: for fixed steps,
  /// else null; passes_pole: whether it passed through the singularity of a chart; error: the output, which may already
  /// have a warning.
  EndErrorEstimator(const Problem& problem, int order, const Result& first, const Options& options,
                    StepAdequacy* adequacy, bool passes_pole, EndErrorEstimate& error)
      : problem_(problem),
        order_(order),
        first_(first),
        options_(options),
        method_(method_named(problem.solver)),
        adequacy_(adequacy),
        passes_pole_(passes_pole),
        error_(error),
        impulses_(problem.n(), problem.n()) {}

  void run() {
    const auto start = std::chrono::steady_clock::now();
    ErrorEstimate estimate = repeat();
    if (adequacy_ != nullptr) add_rounding_error(estimate);
    if (method_.needs.required.has(Feature::momenta)) add_rate_rounding(estimate);
    const std::size_t states = problem_.code->layout().size();
    error_.states.assign(estimate.x.begin(), estimate.x.begin() + static_cast<std::ptrdiff_t>(states));
    for (const double e : error_.states) error_.max = std::max(error_.max, e);
    if (first_.outcome == Outcome::stopped_by_event) error_.t = stop_;
    error_.rhs_evaluations = estimate.statistics.rhs_evaluations + impulses_.evaluations();
    if (estimate.outcome != Outcome::done)
      error_.warning = {EstimateWarning::Kind::tighter_run_differs, 0, 0, estimate.outcome};
    error_.is_by_looser_run = estimate.is_by_looser_run;
    if (!estimate.has_same_outcome) warn({EstimateWarning::Kind::event_not_reached});
    if (adequacy_ != nullptr) check_resolution();
    impulses_.finish();
    check_impulses();
    if (!estimate.converging) warn({EstimateWarning::Kind::not_converging});
    if (method_.needs.required.has(Feature::momenta)) check_frozen_positions();
    error_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  static constexpr double warning_threshold = 1e-3;  // of a velocity

  void warn(const EstimateWarning& warning) {
    if (!error_.warning) error_.warning = warning;
  }

  void raise_estimate(std::size_t state, double estimate) {
    error_.states[state] = std::max(error_.states[state], estimate);
    error_.max = std::max(error_.max, error_.states[state]);
  }

  /// Removes whole turns between two runs for angles that were read off another chart. After a passage through a pole
  /// they are part of the error.
  void align(const std::vector<double>& first, std::vector<double>& other) const {
    if (passes_pole_) return;
    constexpr double turn = 2 * std::numbers::pi;
    for (const ExchangedChart& chart : problem_.charts) {
      for (const std::size_t angle : chart.angles)
        other[angle] += turn * std::round((first[angle] - other[angle]) / turn);
    }
  }

  /// Makes the repeated runs. If the steps are fixed, the first one is also compared with the run on the way.
  ErrorEstimate repeat() {
    Integration again(problem_);
    RunContext& context = again.context();
    bool compared = false;
    stop_ = std::numeric_limits<double>::epsilon() * std::abs(first_.t);
    const auto run = [&](const Options& tighter) {
      const Observer compare = [&](const StepView& step) {
        if (context.charts.second_charts() != 0) return true;
        adequacy_->compare(step, [&](const auto& one, auto& two) { align(one, two); });
        impulses_.observe_step(step, [&](double t, const double* x, double* dx) { return context.rhs(t, x, dx); });
        return true;
      };
      const bool on_the_way = adequacy_ != nullptr && !std::exchange(compared, true);
      Result other = again.run(tighter, on_the_way ? compare : Observer{});
      if (other.outcome == first_.outcome) {
        other.x = context.own_state(other.t, other.x);
        align(first_.x, other.x);
      }
      if (other.outcome == Outcome::done || other.outcome == first_.outcome)
        stop_ = std::max(stop_, std::abs(other.t - first_.t));
      return other;
    };
    return estimate_error(order_, problem_.t0, first_, options_, run, problem_.estimate_cost);
  }

  /// For fixed steps: the effect of the last digits of the start on the end.
  void add_rounding_error(ErrorEstimate& estimate) {
    Result other = run_from_perturbed_start(problem_, options_);
    ++estimate.runs;
    estimate.statistics += other.statistics;
    if (other.outcome != first_.outcome) {
      error_.warning = {EstimateWarning::Kind::sensitive_start, 0, 0, other.outcome};
      return;
    }
    align(first_.x, other.x);
    for (std::size_t i = 0; i < first_.x.size(); ++i) {
      const double difference = std::abs(first_.x[i] - other.x[i]);
      estimate.x[i] =
          std::max(estimate.x[i], std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference);
    }
  }

  void add_rate_rounding(ErrorEstimate& estimate) const {
    const std::vector<double> rates = rate_rounding(problem_, first_.t, first_.x);
    for (std::size_t i = 0; i < rates.size(); ++i) {
      double& of = estimate.x[problem_.n() + i];
      of = std::max(of, rates[i]);
    }
  }

  /// If fixed steps do not resolve the motion, the end states are not conclusive, and the differences on the way are
  /// the estimate.
  void check_resolution() {
    if (!(adequacy_->largest() > StepAdequacy::unresolved)) return;
    const std::vector<double>& differences = adequacy_->differences();
    for (std::size_t i = 0; i < std::min(differences.size(), error_.states.size()); ++i)
      raise_estimate(i, differences[i]);
    warn({EstimateWarning::Kind::unresolved, 0, adequacy_->largest()});
  }

  /// If a force turns within one step, its impulse acts at the wrong place. The resulting error of the velocity is part
  /// of the end state but not of the differences between end states.
  void check_impulses() {
    double at = 0;
    const double part = 2 * impulses_.largest(at);  // measured with steps of half the size
    if (!(part > 0)) return;
    for (std::size_t i = 0; i < error_.states.size(); ++i) raise_estimate(i, part * std::abs(first_.x[i]));
    if (part < warning_threshold) return;
    warn({EstimateWarning::Kind::impulse, at, part});
  }

  /// If the steps are so short that positions change only in their last digits, rounding satisfies the position
  /// constraints and determines the rates.
  void check_frozen_positions() {
    constexpr double digits = 100 * std::numeric_limits<double>::epsilon();
    const std::size_t n = problem_.n();
    double position = 0, rate = 0;
    for (std::size_t i = 0; i < n; ++i) {
      position = std::max(position, std::abs(first_.x[i]));
      rate = std::max(rate, std::abs(first_.x[n + i]));
    }
    if (problem_.code->active_constraints == 0 || !(rate > 0) || options_.fixed_step * rate >= digits * position)
      return;
    warn({EstimateWarning::Kind::positions_frozen, 0, options_.fixed_step});
  }

  const Problem& problem_;
  int order_;
  const Result& first_;
  const Options& options_;
  const MethodInfo& method_;
  StepAdequacy* adequacy_;
  bool passes_pole_;
  EndErrorEstimate& error_;
  UnresolvedImpulses impulses_;
  double stop_ = 0;
};

}  // namespace eom::hybrid
