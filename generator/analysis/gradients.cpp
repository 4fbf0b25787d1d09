// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/gradients.hpp"

#include "analysis/sensitivities.hpp"
#include "run/parameters.hpp"
#include "run/requested_outputs.hpp"

namespace eomgen::analysis {
std::vector<std::string> gradient_outputs(pipeline::DerivedModel& derived, const std::vector<std::string>& names) {
  return run::requested_outputs(derived.mechanics, derived.candidates.front(), names);
}

run::Gradients gradients(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request,
                         const std::vector<std::string>& outputs, std::vector<std::string> by) {
  if (by.empty()) {
    pipeline::DerivedModel& derived = *simulation.derived;
    by = run::independent_parameters(derived.mechanics, derived.model.scene(request.scene), request.overrides);
  }
  const run::RunRequest run = differentiable_run(simulation, request);
  const std::vector<run::Direction> directions = directions_of(simulation, request, run, by);
  return run::integrate_gradients(run, simulation.result,
                                  {directions, outputs, simulation.code.functions().adjoint, request.estimate});
}

}  // namespace eomgen::analysis
