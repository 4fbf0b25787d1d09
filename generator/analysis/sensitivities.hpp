// SPDX-License-Identifier: GPL-3.0-or-later
// What `run --sensitivity` is about: names into directions, and the derivatives of a finished run.
#pragma once

#include "pipeline/simulate.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::analysis {

/// Functions of the code that are needed beside those of the run.
inline constexpr const char* sensitivity_functions[] = {"jac", "jac_p"};

/// `names`: parameters, coordinates (their value at the start), NAME_dot. Throws Error{stage "run"}: an unknown name, a
/// value that follows from others, a start that cannot follow the change.
run::Sensitivities sensitivities(const pipeline::Simulation& simulation, const pipeline::SimulationRequest& request,
                                 const std::vector<std::string>& names);

}  // namespace eomgen::analysis
