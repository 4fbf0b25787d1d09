// SPDX-License-Identifier: GPL-3.0-or-later
// Gradients of outputs at the end of a run (`run --gradient`), by parameters and initial values.
#pragma once

#include "pipeline/simulate.hpp"
#include "run/gradient.hpp"

namespace eomgen::analysis {

/// The outputs that these names request: coordinates, rates, states and outputs, vectors by components. Throws
/// Error{stage "run"} for an unknown name.
std::vector<std::string> gradient_outputs(pipeline::DerivedModel& derived, const std::vector<std::string>& names);

/// outputs: from gradient_outputs(), which the code of the simulation has. by: as `names` of sensitivities(); none:
/// every parameter with a value of its own. The simulation was requested with the function `adjoint`. Throws
/// Error{stage "run"} as sensitivities() does.
run::Gradients gradients(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request,
                         const std::vector<std::string>& outputs, std::vector<std::string> by);

}  // namespace eomgen::analysis
