// SPDX-License-Identifier: GPL-3.0-or-later
// Restriction of a function to some of its results.
#pragma once

#include <vector>

#include "program/program.hpp"

namespace eomgen::program {

/// `function` with the given entries of its first result only, in this order, and the code that they need. Pivot tests
/// are removed: entries may be infinite or NaN where the original function returns 1.
Function restrict_results(const Function& function, const std::vector<std::size_t>& entries);

}  // namespace eomgen::program
