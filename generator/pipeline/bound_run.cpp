// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/bound_run.hpp"

#include <algorithm>
#include <utility>

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

run::Code bound_code(const Compilation& compilation) {
  run::Code code = compilation.code.code_for_run();
  code.kink_values = compilation.kink_values;
  return code;
}

}  // namespace

BoundRun::BoundRun(const DerivedModel& derived, const Compilation& compilation, run::Scene scene, bool estimate)
    : scene_(std::move(scene)),
      code_(bound_code(compilation)),
      request_(make_run_request(derived, scene_, code_, estimate, &compilation.bounded_functions)) {
  allow_charts(request_, compilation.charts);
}

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
