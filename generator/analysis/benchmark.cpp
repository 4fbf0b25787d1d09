// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "analysis/impulse_in_digits.hpp"
#include "bench/libraries.hpp"
#include "error.hpp"
#include "run/integration.hpp"

namespace eomgen::analysis {
namespace {

using pipeline::Simulation;
using Clock = std::chrono::steady_clock;

constexpr std::size_t looks = 100;  // samples of the error along the run
constexpr int fewest_digits = 8;    // required of the reference solution

[[noreturn]] void unsupported(const std::string& what, const std::string& remedy) {
  throw Error("bench", {}, "there is no reference for this scene: " + what, remedy);
}

/// The run before any measurement: reports if there can be no reference solution. Returns the times at which supports
/// give an impulse.
std::vector<double> require_smooth(const Simulation& simulation, const run::RunRequest& request) {
  if (!simulation.program.contacts.empty() || !simulation.program.contact_set.empty())
    unsupported("contacts and friction change the equations on the way", "eomgen run gives an error_estimate");
  if (request.has_resets()) unsupported("events or samples change the state", "eomgen run gives an error_estimate");
  for (const run::Signal& signal : simulation.scene.inputs) {
    if (signal.is_varying())
      unsupported("an input is an expression of t", "write it into the force, or give it as a table");
  }
  // A scene with a fixed step may not be solvable with adaptive steps.
  run::Integration trial(request, simulation.scene.step > 0 ? "rk4" : "dop853");
  eom::Options options;
  options.fixed_step = simulation.scene.step;
  options.interrupt = request.interrupt;
  std::vector<double> impulses;
  const eom::Result end = trial.run(options, {}, [&](const eom::hybrid::Event& event, std::span<const double>) {
    if (event.kind == "impulse") impulses.push_back(event.t);
  });
  if (trial.kink_crossings() > 0)
    unsupported("the motion crosses a kink (abs, sign, min, max, if, atan2)",
                "shorten the run (--t-end), or smooth the law");
  if (end.outcome == eom::Outcome::done) return impulses;
  throw Error("bench", {},
              fmt::format("the run ends at t = {} with '{}' {}", end.t, eom::name(end.outcome), end.detail),
              "give an end before that: --t-end",
              end.outcome == eom::Outcome::stopped_by_event ? ErrorKind::input : ErrorKind::numerical);
}

std::vector<double> inputs_at(const run::Scene& scene, double t) {
  std::vector<double> u;
  for (const run::Signal& signal : scene.inputs) u.push_back(signal(t, t));
  return u;
}

/// impulses: times at which supports give one.
reference::Problem make_problem(const Simulation& simulation, const run::RunRequest& request,
                                const std::vector<double>& times, const std::vector<double>& impulses) {
  const run::Scene& scene = simulation.scene;
  const run::Integration trial(request, "dop853");
  const std::vector<eom::hybrid::Segment> segments = trial.segments();
  reference::Problem problem{
      simulation.program.functions.front(), trial.initial_state(), scene.parameters, trial.begin(), {}, times};
  problem.interrupt = request.interrupt;
  problem.coordinates = simulation.program.free.size();
  for (const program::Function& function : simulation.program.functions) {
    if (function.name == "constraints") problem.constraints = &function;
  }
  double from = problem.t0;
  std::vector<ImpulseInDigits::Kink> kinks;
  for (const auto& [end, next, step] : segments) {
    problem.segments.push_back({end, inputs_at(scene, (from + end) / 2), next});
    if (!kinks.empty()) kinks.back().u_behind = problem.segments.back().u;
    kinks.push_back({end, next, problem.segments.back().u, problem.segments.back().u});
    from = next;
  }
  const auto impulse = std::make_shared<ImpulseInDigits>(simulation.derived->candidates.front(), scene.parameters);
  problem.cross_kink = [=, t1 = scene.t1](std::size_t segment, std::vector<cln::cl_F>& x, int digits) {
    const ImpulseInDigits::Kink& kink = kinks[segment];
    if (std::find(impulses.begin(), impulses.end(), std::min(kink.behind, t1)) != impulses.end())
      impulse->apply(kink, x, digits);
  };
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
  request.model = asked.model;
  request.scene = asked.scene;
  request.overrides = asked.overrides;
  request.overrides.solver = "dop853";
  request.approach = asked.approach;
  request.form = asked.form;
  request.every_solver = true;
  request.integrate = false;
  request.seed = asked.seed;
  request.tier = pipeline::Tier::compiled;  // solvers of other libraries call compiled code too
  return request;
}

}  // namespace

bool Benchmark::conclusive() const {
  const bool any = std::any_of(rows.begin(), rows.end(), [](const bench::Row& row) { return row.outcome == "done"; });
  return any && reference.digits_at_end >= fewest_digits;
}

Benchmark benchmark(const BenchmarkRequest& asked) {
  Benchmark result{pipeline::simulate(simulation_request(asked)), {}, {}, {}, {}, 0};
  const Simulation& simulation = result.simulation;
  const work::DeferInterrupt kept;
  const auto show = [&asked](const std::string& what) {
    if (asked.progress) asked.progress(what);
  };
  const run::Code code = simulation.code.code_for_run();
  run::RunRequest request = pipeline::make_run_request(*simulation.derived, simulation.scene, code, false);
  request.watch_power = false;
  request.interrupt = asked.interrupt;
  const std::vector<double> impulses = require_smooth(simulation, request);
  const run::Scene& scene = simulation.scene;
  std::vector<double> times;
  for (std::size_t k = 1; k < looks; ++k)
    times.push_back(scene.t0 + (scene.t1 - scene.t0) * static_cast<double>(k) / looks);
  times.push_back(scene.t1);

  reference::Problem problem = make_problem(simulation, request, times, impulses);
  problem.progress = [&show](double fraction) { show(fmt::format("reference: {:.0f} %", 100 * fraction)); };
  const Clock::time_point start = Clock::now();
  result.reference = reference::solve(problem);
  result.reference_seconds = std::chrono::duration<double>(Clock::now() - start).count();

  bench::Request measured{request, result.reference, times, solvers_for(asked, scene, request.code, result.left_out)};
  measured.seconds_limit = asked.max_seconds;
  if (asked.other_libraries && asked.solvers.empty()) {
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
