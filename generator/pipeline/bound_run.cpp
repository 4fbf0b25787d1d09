// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/bound_run.hpp"

#include <algorithm>
#include <utility>

#include "run/bind.hpp"
#include "run/integration.hpp"

namespace eomgen::pipeline {
namespace {

/// Allows the run to change to the charts of the library.
void allow_charts(run::RunRequest& run, const std::shared_ptr<ChartLibrary>& library) {
  if (!library) return;
  for (const model::ChartPair& chart : library->charts()) {
    run::ExchangedChart exchanged{chart.of, {}, chart.angles, chart.guarded, chart.at_sine, true};
    exchanged.second_at_sine = chart.kind == model::ChartPair::Kind::position || !chart.at_sine;
    for (const std::uint32_t angle : chart.angles) {
      const auto place = std::find(run.code.free.begin(), run.code.free.end(), angle);
      exchanged.angles.push_back(static_cast<std::size_t>(place - run.code.free.begin()));
    }
    run.charts.push_back(std::move(exchanged));
  }
  run.code_for_charts = [library,
                         visited = std::make_shared<std::vector<unsigned>>()](unsigned charts) -> const run::Code& {
    if (std::find(visited->begin(), visited->end(), charts) == visited->end()) visited->push_back(charts);
    return library->code_for(*visited);
  };
}

}  // namespace

run::RunRequest make_run_request(const DerivedModel& derived, const Compilation& compilation, const run::Scene& scene,
                                 bool estimate) {
  run::RunRequest run =
      describe_run(derived, scene, compilation.code.code_for_run(), estimate, compilation.bounded_functions);
  allow_charts(run, compilation.charts);
  return run;
}

BoundRun::BoundRun(const DerivedModel& derived, const Compilation& compilation, run::Scene scene, bool estimate)
    : scene_(std::move(scene)), request_(make_run_request(derived, compilation, scene_, estimate)) {}

run::RunResult BoundRun::integrate() const { return run::integrate_scene(request_); }

run::RunResult BoundRun::integrate(const RunPlan& plan, const RunControl& control) {
  request_.row = control.row;
  request_.progress = control.progress;
  request_.interrupt = control.interrupt;
  request_.max_steps = control.max_steps;
  request_.estimate_cost = control.estimate_cost;
  run::RunResult result = integrate();
  result.reason.charts_refused = plan.charts_refused;
  result.reason.charts_kept_for_jumps = plan.charts_kept_for_jumps;
  return result;
}

eom::hybrid::Problem BoundRun::problem(const std::string& solver) const { return run::make_problem(request_, solver); }

run::RunResult rerun(const Simulation& simulation, const run::Overrides& overrides, bool estimate,
                     eom::EstimateCost cost) {
  DerivedModel& derived = *simulation.derived;
  run::Overrides allowed = overrides;
  allowed.can_exchange_charts = simulation.charts != nullptr;
  BoundRun run(derived, simulation,
               run::resolve_scene(derived.mechanics, derived.candidates.front(),
                                  derived.model.scene(simulation.scene.name), allowed, derived.scene_tables),
               estimate);
  run.request().estimate_cost = cost;
  return run.integrate();
}

}  // namespace eomgen::pipeline
