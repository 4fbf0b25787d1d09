// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sensitivities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "model/names.hpp"
#include "pipeline/bound_run.hpp"
#include "work.hpp"

namespace eomgen::analysis {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
  throw Error("run", {}, "no derivatives of the end: " + what, remedy);
}

/// Rejects names without a direction of their own.
void require_direction(const model::Model& model, const run::Code& code, const std::vector<std::string>& states,
                       const std::string& name) {
  for (const model::Parameter& p : model.parameters) {
    if (p.name == name) return;
  }
  const auto state = std::find(states.begin(), states.end(), name);
  if (state - states.begin() < static_cast<std::ptrdiff_t>(code.layout().first_order_begin())) return;
  if (run::find_state(model, name)) return;
  if (state != states.end()) refuse(name + " is an integral over time, 0 at the start", "ask for a coordinate");
  if (run::find_start(model, name))
    refuse("the start of " + name + " follows from other values", "ask for one of those that it follows from");
  std::vector<std::string> known = states;
  for (const model::Parameter& p : model.parameters) known.push_back(p.name);
  refuse("there is no parameter or coordinate '" + name + "'", model::suggest_choice(name, known));
}

}  // namespace

std::vector<std::string> sensitivity_functions(const model::Model& model) {
  std::vector<std::string> functions{"jac", "jac_p"};
  if (!model.inputs.empty()) functions.emplace_back("jac_u");
  return functions;
}

run::RunRequest differentiable_run(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request) {
  run::RunRequest run = pipeline::make_run_request(*simulation.derived, simulation, simulation.scene, false);
  run.interrupt = request.interrupt;
  run.max_steps = request.max_steps;
  return run;
}

std::vector<run::Direction> directions_of(const pipeline::Simulation& simulation,
                                          const pipeline::SimulationRequest& request, const run::RunRequest& run,
                                          const std::vector<std::string>& names) {
  pipeline::DerivedModel& derived = *simulation.derived;
  const run::ModelScene scene{derived.mechanics,     derived.candidates.front(), derived.model.scene(request.scene),
                              request.overrides,     simulation.scene,           run.code.free,
                              run.state_names.size()};
  std::vector<run::Direction> directions;
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) {
      work::warn(fmt::format("warning: derivatives by '{}' are asked for twice\n  remedy: name it once\n", name));
      continue;
    }
    require_direction(derived.model, run.code, run.state_names, name);
    directions.push_back(run::find_direction(scene, name));
  }
  return directions;
}

run::Sensitivities sensitivities(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request,
                                 const std::vector<std::string>& names) {
  const run::RunRequest run = differentiable_run(simulation, request);
  return run::integrate_sensitivities(run, simulation.result, directions_of(simulation, request, run, names),
                                      request.estimate);
}

}  // namespace eomgen::analysis
