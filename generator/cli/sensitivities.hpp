// SPDX-License-Identifier: GPL-3.0-or-later
// What `run --sensitivity` is about: names into directions, and the derivatives of a finished run.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/simulate.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::cli {

/// Functions of the code that are needed beside those of the run.
inline constexpr const char* sensitivity_functions[] = {"jac", "jac_p"};

/// `names`: parameters, coordinates (their value at the start), NAME_dot. Throws Error{stage "run"}: an unknown name, a
/// value that follows from others, a start that cannot follow the change.
run::Sensitivities sensitivities(const Simulation& simulation, const SimulationRequest& request,
                                 const std::vector<std::string>& names);

std::string text_of(const run::Sensitivities& found, const std::vector<std::string>& states);
/// {"method", "t", "outcome", "values": {of: {state: value}}, "error_estimate": the same or null, "rhs_evaluations"}
nlohmann::ordered_json json_of(const run::Sensitivities& found, const std::vector<std::string>& states);

}  // namespace eomgen::cli
