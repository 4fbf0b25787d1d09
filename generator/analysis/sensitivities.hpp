// SPDX-License-Identifier: GPL-3.0-or-later
// Sensitivities of the final state of a run (`run --sensitivity`): derivatives by parameters and initial values; the
// directions of these derivatives.
#pragma once

#include "pipeline/simulate.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::analysis {

/// Generated functions that sensitivities need in addition to those of a run.
std::vector<std::string> sensitivity_functions(const model::Model& model);

/// The run of a simulation without rows and estimate; it refers to the simulation.
run::RunRequest differentiable_run(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request);

/// `names`: parameters, coordinates (initial value) and NAME_dot (initial rate). Throws Error{stage "run"} for an
/// unknown name, a dependent value, or an initial state that cannot be adjusted to the change.
std::vector<run::Direction> directions_of(const pipeline::Simulation& simulation,
                                          const pipeline::SimulationRequest& request, const run::RunRequest& run,
                                          const std::vector<std::string>& names);

/// Derivatives of the end of the run in these directions (directions_of).
run::Sensitivities sensitivities(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request,
                                 const std::vector<std::string>& names);

}  // namespace eomgen::analysis
