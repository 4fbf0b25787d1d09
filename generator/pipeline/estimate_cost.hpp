// SPDX-License-Identifier: GPL-3.0-or-later
// The words for the cost of error estimates.
#pragma once

#include <eom/run_types.hpp>
#include <string>
#include <vector>

namespace eomgen::pipeline {

std::vector<std::string> estimate_cost_names();                  // "bounded", "full"
eom::EstimateCost parse_estimate_cost(const std::string& text);  // from one of these names; throws Error

}  // namespace eomgen::pipeline
