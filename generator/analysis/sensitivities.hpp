// SPDX-License-Identifier: GPL-3.0-or-later
// Sensitivities of the final state of a run (`run --sensitivity`): derivatives by parameters and initial values.
#pragma once

#include "pipeline/simulate.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::analysis {

/// Generated functions that sensitivities need in addition to those of a run.
std::vector<std::string> sensitivity_functions(const model::Model& model);

/// `names`: parameters, coordinates (initial value) and NAME_dot (initial rate). Throws Error{stage "run"} for an
/// unknown name, a dependent value, or an initial state that cannot be adjusted to the change.
run::Sensitivities sensitivities(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request,
                                 const std::vector<std::string>& names);

}  // namespace eomgen::analysis
