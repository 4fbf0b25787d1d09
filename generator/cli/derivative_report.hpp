// SPDX-License-Identifier: GPL-3.0-or-later
// The sensitivities and the gradients of a run as text and in its JSON document.
#pragma once

#include <string>
#include <vector>

#include "cli/json.hpp"
#include "run/gradient.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::cli {

std::string text_of(const run::Sensitivities& found, const std::vector<std::string>& states);
/// {"method", "t", "outcome", "values": {of: {state: value}}, "error_estimate": the same or null, "rhs_evaluations"}
Json json_of(const run::Sensitivities& found, const std::vector<std::string>& states);

std::string text_of(const run::Gradients& found);
/// {"method", "t", "outcome", "outputs": {output: value}, "values": {output: {of: derivative}}, "error_estimate": as
/// values or null, "rhs_evaluations", "adjoint_evaluations", "seconds"}
Json json_of(const run::Gradients& found);

}  // namespace eomgen::cli
