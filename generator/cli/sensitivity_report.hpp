// SPDX-License-Identifier: GPL-3.0-or-later
// Output of `run --sensitivity` as text and JSON.
#pragma once

#include <string>
#include <vector>

#include "cli/json.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::cli {

std::string text_of(const run::Sensitivities& found, const std::vector<std::string>& states);
/// {"method", "t", "outcome", "values": {of: {state: value}}, "error_estimate": the same or null, "rhs_evaluations"}
Json json_of(const run::Sensitivities& found, const std::vector<std::string>& states);

}  // namespace eomgen::cli
