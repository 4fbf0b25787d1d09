// SPDX-License-Identifier: MIT
// hybrid::run: one integration for the result, others for the error estimate. Compiled where the code of runs is
// (compiled_runtime.hpp). In: a Problem. Out: its RunResult.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eom/hybrid/balance.hpp"
#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/estimate.hpp"
#include "eom/hybrid/integration.hpp"
#include "eom/hybrid/run.hpp"
#include "eom/hybrid/run_monitor.hpp"
#include "eom/hybrid/run_options.hpp"
#include "eom/hybrid/run_result.hpp"
#include "eom/hybrid/time_analysis.hpp"

namespace eom::hybrid {

/// A parameter that is not finite makes the result invalid, even if no number of the result shows it (comparisons are
/// false then).
inline void require_parameters(const Problem& problem, RunResult& result) {
  if (!result.ended() || std::all_of(problem.parameters.begin(), problem.parameters.end(),
                                     [](double value) { return std::isfinite(value); }))
    return;
  result.outcome = Outcome::not_finite;
  result.reason = {Reason::Kind::parameter, result.t};
}

EOM_RUNTIME_INLINE RunResult run(const Problem& problem, RuntimeLayout) {
  require_functions(problem);
  const bool follow = std::any_of(problem.samples.begin(), problem.samples.end(),
                                  [](const Sample& sample) { return !sample.times.empty(); });
  if (!problem.time.empty() || follow) {
    Problem looked = problem;
    evaluate_sample_times(looked.samples, looked.parameters);
    for (Sample& sample : looked.samples) sample.times = {};
    looked.time = {};
    TimeAnalysis clock{problem.breakpoints, problem.bounds, {}};
    if (!problem.time.empty())
      clock = analyse_time_functions(problem.time, problem.parameters, problem.inputs, problem.t0, problem.t1);
    looked.breakpoints = std::move(clock.breakpoints);
    looked.bounds = std::move(clock.bounds);
    RunResult result = run(looked);
    result.time_unresolved_from = clock.unresolved_from;
    return result;
  }
  const Options options = options_of(problem);
  Integration integration(problem);
  RunContext& context = integration.context();
  RunMonitor monitor(problem, context);
  std::optional<StepAdequacy> adequacy;
  const std::vector<Contact>& contacts = problem.code->contacts;
  const bool impacts =
      problem.code->contact_set.can_open() ||
      std::any_of(contacts.begin(), contacts.end(), [](const Contact& contact) { return contact.unilateral; });
  if (problem.estimate && options.fixed_step > 0) adequacy.emplace(impacts);
  const auto observe = [&](const StepView& view) {
    if (adequacy && context.charts.second_charts() == 0) adequacy->observe_step(view);
    return monitor.step(view);
  };
  const auto record_event = [&](const Event& event, std::span<const double> x) { monitor.event(event, x); };
  const auto begin = std::chrono::steady_clock::now();
  const bool moves = problem.t1 != problem.t0;
  Result end = moves ? integration.run(options, observe, record_event)
                     : Result{Outcome::done, problem.t0, context.start, {}, ""};
  RunResult result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.reason = integration.reason();
  const double at = monitor.finish(end, moves ? integration.end_time() : problem.begin(), result.reason);
  monitor.report(result);
  result.choice = integration.choice();
  result.solver = result.choice.method != nullptr ? result.choice.method : problem.solver;
  result.outcome = end.outcome;
  result.t = end.t;
  result.statistics = end.statistics;
  result.kink_crossings = context.kinks.crossings();
  result.projection_position = context.projection.largest().position;
  result.projection_velocity = context.projection.largest().velocity;
  result.projection_work = context.projection.work();
  result.impulse_work = context.impulse_work;
  result.contact_forces_determined = !context.solved_contacts || context.solved_contacts->forces_determined();
  result.contact_residual = context.solved_contacts ? context.solved_contacts->largest_residual() : 0;
  result.outputs.resize(problem.code->output_names.size());
  context.outputs(at, end.x.data(), result.outputs);
  result.state = context.own_state(at, end.x);
  require_parameters(problem, result);
  const std::optional<Integration::MissedForce>& missed = integration.missed_narrow_force();
  const auto report_missed_force = [&] {
    result.error.warning = {EstimateWarning::Kind::missed_narrow_force, missed->t};
  };
  if (missed && !missed->has_tails) report_missed_force();
  result.narrow_forces_unresolved_from = integration.narrow_forces_unresolved_from();
  const bool ended = result.ended();
  if (problem.estimate && ended && moves) {
    Result own = end;
    own.x = result.state;
    const bool passes_pole = std::any_of(result.events.begin(), result.events.end(),
                                         [](const Event& event) { return event.kind == "pole"; });
    EndErrorEstimator(problem, method_named(result.solver).order, own, options, adequacy ? &*adequacy : nullptr,
                      passes_pole, result.error)
        .run();
    integration.narrow_forces().add_passed_over(result.t, result.error.states);
    for (const double estimate : result.error.states) result.error.max = std::max(result.error.max, estimate);
  }
  // An estimate that saw a force with tails states its effect.
  const EstimateWarning::Kind found = result.error.warning.kind;
  if (missed && missed->has_tails && found != EstimateWarning::Kind::impulse &&
      found != EstimateWarning::Kind::tighter_run_differs && found != EstimateWarning::Kind::sensitive_start)
    report_missed_force();
  if (ended) {
    require_balance(problem, result, monitor.energy_defect(), end.x, [&](const std::vector<double>& x) {
      std::vector<double> outputs(problem.code->output_names.size());
      context.outputs(at, x.data(), outputs);
      return outputs[problem.energy];
    });
  }
  result.detail = sentence(result.reason);
  result.error.note = sentence(result.error.warning);
  return result;
}

}  // namespace eom::hybrid
