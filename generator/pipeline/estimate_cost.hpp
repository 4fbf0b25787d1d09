// SPDX-License-Identifier: GPL-3.0-or-later
// The words for the cost of error estimates.
#pragma once

#include <eom/run_types.hpp>
#include <string>
#include <vector>

namespace eomgen::pipeline {

std::vector<std::string> estimate_cost_names();  // "bounded", "full"

/// The cost by its name. without: the caller leaves estimates out. Throws Error if there is no such name, and for
/// "full" without estimates.
eom::EstimateCost parse_estimate_cost(const std::string& text, bool without);

}  // namespace eomgen::pipeline
