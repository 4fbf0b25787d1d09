// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <eom/hybrid/samples.hpp>
#include <memory>

#include "analysis/reference_boundaries.hpp"
#include "bench/libraries.hpp"
#include "error.hpp"
#include "pipeline/bound_run.hpp"
#include "run/integration.hpp"

namespace eomgen::analysis {
namespace {

using pipeline::Simulation;
using Clock = std::chrono::steady_clock;

constexpr std::size_t looks = 100;  // samples of the error along the run
constexpr int fewest_digits_across_kinks = 20;
constexpr int fewest_digits = 8;                        // required of the reference solution
constexpr double golden_section = 0.38196601125010515;  // of the spacing: errors are not measured at round times

/// The run before any measurement: reports if there can be no reference solution.
ReferenceTrial require_reference(const Simulation& simulation, const run::RunRequest& request) {
  if (!simulation.program.contacts.empty() || !simulation.program.contact_set.empty())
    refuse_reference("contacts and friction change the equations on the way", "eomgen run gives an error_estimate");
  for (const run::Signal& signal : simulation.scene.inputs) {
    if (signal.is_linear_table() && signal.is_varying())
      refuse_reference("an input is a table with linear interpolation",
                       "take interpolation = \"hold\" in another scene, or read the error_estimate of eomgen run");
    if (signal.is_varying())
      refuse_reference("an input is an expression of t", "write it into the force, or give it as a table");
  }
  // A scene with a fixed step may not be solvable with adaptive steps.
  run::Integration trial(request,
                         simulation.scene.step > 0 ? run::default_solvers.fixed_step : run::default_solvers.adaptive);
  eom::Options options;
  options.fixed_step = simulation.scene.step;
  options.interrupt = request.interrupt;
  if (request.has_resets() && options.fixed_step == 0) options.rtol = options.atol = trial_tolerance;
  ReferenceTrial found;
  const auto named = [](const auto& list, const std::string& name) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.name == name; });
    return static_cast<std::size_t>(at - list.begin());
  };
  const eom::Result end = trial.run(options, {}, [&](const eom::hybrid::Event& event, std::span<const double>) {
    if (event.kind == "impulse") found.impulses.push_back(event.t);
    if (event.kind == "before_reset")
      found.changes.push_back({StateChange::Kind::event, named(request.events, event.name), event.t});
    if (event.kind == "sample") {
      const std::size_t i = named(request.samples, event.name);
      const auto k = eom::hybrid::sample_between(request.samples[i], event.t, event.t);
      found.changes.push_back({StateChange::Kind::sample, i, event.t, k.value()});
    }
  });
  found.crosses_kinks = trial.kink_crossings() > 0;
  if (end.outcome == eom::Outcome::done) {
    found.x = end.x;
    return found;
  }
  throw Error("bench", {},
              fmt::format("the run ends at t = {} with '{}' {}", end.t, eom::name(end.outcome), end.detail),
              "give an end before that: --t-end",
              end.outcome == eom::Outcome::stopped_by_event ? ErrorKind::input : ErrorKind::numerical);
}

/// Times at which errors are measured; the last is the end. States that jump have no error near their jumps.
std::vector<double> times_of_errors(const run::Scene& scene, const std::vector<StateChange>& changes) {
  const double spacing = (scene.t1 - scene.t0) / looks, shift = changes.empty() ? 0 : golden_section;
  std::vector<double> times;
  for (std::size_t k = 1; k < looks; ++k) {
    const double t = scene.t0 + (static_cast<double>(k) - shift) * spacing;
    const bool jumps = std::any_of(changes.begin(), changes.end(), [&](const StateChange& change) {
      // A sample is at a known time, an event at one that has the error of the run.
      const double near = change.kind == StateChange::Kind::sample ? eom::hybrid::equal_times(t) : spacing / 4;
      return std::abs(t - change.t) <= near;
    });
    if (!jumps) times.push_back(t);
  }
  times.push_back(scene.t1);
  return times;
}

reference::Problem make_problem(const Simulation& simulation, const run::RunRequest& request,
                                const std::vector<double>& times,
                                const std::shared_ptr<ReferenceBoundaries>& boundaries) {
  const run::Integration trial(request, run::default_solvers.adaptive);
  reference::Problem problem{simulation.program.functions.front(),
                             trial.initial_state(),
                             simulation.scene.parameters,
                             trial.begin(),
                             boundaries->segments(trial.begin(), trial.segments()),
                             times};
  problem.interrupt = request.interrupt;
  problem.coordinates = simulation.program.free.size();
  for (const program::Function& function : simulation.program.functions) {
    if (function.name == "constraints") problem.constraints = &function;
  }
  problem.change = [boundaries](std::size_t boundary, const cln::cl_F& t, std::vector<cln::cl_F>& x, int digits) {
    boundaries->change(boundary, t, x, digits);
  };
  problem.event_value = [boundaries](std::size_t segment, const cln::cl_F& t, const std::vector<cln::cl_F>& x,
                                     int digits) { return boundaries->event_value(segment, t, x, digits); };
  return problem;
}

std::vector<std::string> solvers_for(const BenchmarkRequest& options, const run::Scene& scene, const run::Code& code,
                                     std::vector<std::pair<std::string, std::string>>& left_out) {
  std::vector<std::string> chosen;
  for (const std::string& name : run::select_solvers("bench", options.solvers)) {
    const eom::Eligibility found = run::check_eligibility(name, scene, code);
    if (found)
      chosen.push_back(name);
    else if (found.reason == eom::Eligibility::Reason::refused || !options.solvers.empty())
      left_out.emplace_back(name, run::ineligibility_reason(found));  // skips solvers that are made for other models
  }
  return chosen;
}

pipeline::SimulationRequest simulation_request(const BenchmarkRequest& asked) {
  pipeline::SimulationRequest request;
  request.take(asked);
  request.overrides.solver = run::default_solvers.adaptive;
  request.approach = asked.approach;
  request.form = asked.form;
  request.every_solver = true;
  request.integrate = false;
  request.tier = pipeline::Tier::compiled;  // solvers of other libraries call compiled code too
  return request;
}

}  // namespace

bool Benchmark::conclusive() const {
  const bool any = std::any_of(rows.begin(), rows.end(), [](const bench::Row& row) { return row.outcome == "done"; });
  return any && reference.digits_at_end >= fewest_digits;
}

Benchmark benchmark(const BenchmarkRequest& asked) {
  run::select_solvers("bench", asked.solvers);  // an unknown name is refused before the derivation
  Benchmark result{pipeline::simulate(simulation_request(asked)), {}, {}, {}, {}, 0};
  const Simulation& simulation = result.simulation;
  const work::DeferInterrupt kept;
  const auto show = [&asked](const std::string& what) {
    if (asked.progress) asked.progress(what);
  };
  result.simulation.charts.reset();  // the reference stays in the model's own coordinates
  run::RunRequest request = pipeline::make_run_request(*simulation.derived, simulation, simulation.scene, false);
  request.watch_power = false;
  request.interrupt = asked.interrupt;
  ReferenceTrial trial = require_reference(simulation, request);
  const run::Scene& scene = simulation.scene;
  const std::vector<double> times = times_of_errors(scene, trial.changes);
  const bool crosses_kinks = trial.crosses_kinks;
  const auto boundaries = std::make_shared<ReferenceBoundaries>(
      simulation.program, simulation.derived->candidates.front(), request, std::move(trial));
  reference::Problem problem = make_problem(simulation, request, times, boundaries);
  problem.progress = [&show](double fraction) { show(fmt::format("reference: {:.0f} %", 100 * fraction)); };
  const Clock::time_point start = Clock::now();
  result.reference = reference::solve(problem);
  result.reference_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  // A series does not follow a bend. Where the equations are smooth, as atan2 ahead of its cut, it keeps its digits.
  if (crosses_kinks && result.reference.digits_at_end < fewest_digits_across_kinks)
    refuse_reference("the motion crosses a kink (abs, sign, min, max, if, atan2)",
                     "shorten the run (--t-end), or smooth the law");
  boundaries->require_same_end(result.reference);

  bench::Request measured{request, result.reference, times, solvers_for(asked, scene, request.code, result.left_out)};
  measured.seconds_limit = asked.max_seconds;
  if (asked.other_libraries && asked.solvers.empty() && request.has_resets()) {
    result.left_out.emplace_back("solvers of other libraries", "events or samples change the state");
  } else if (asked.other_libraries && asked.solvers.empty()) {
    show("compiling what calls other libraries");
    bench::FoundLibraries found = bench::find_libraries(request, problem.x, asked.max_seconds);
    measured.external_solvers = std::move(found.external_solvers);
    result.left_out.insert(result.left_out.end(), found.left_out.begin(), found.left_out.end());
  }
  measured.progress = show;
  result.rows = bench::measure(measured);
  result.states = request.state_names;
  return result;
}

}  // namespace eomgen::analysis
