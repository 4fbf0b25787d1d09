// SPDX-License-Identifier: GPL-3.0-or-later
// Output of `run --gradient` as text and JSON.
#pragma once

#include <string>

#include "cli/json.hpp"
#include "run/gradient.hpp"

namespace eomgen::cli {

std::string text_of(const run::Gradients& found);
/// {"method", "t", "outcome", "outputs": {output: value}, "values": {output: {of: derivative}}, "error_estimate": as
/// values or null, "rhs_evaluations", "adjoint_evaluations", "seconds"}
Json json_of(const run::Gradients& found);

}  // namespace eomgen::cli
