// SPDX-License-Identifier: GPL-3.0-or-later
// A function with fewer results.
#pragma once

#include <vector>

#include "program/program.hpp"

namespace eomgen::program {

/// `function` with these entries of its first result alone, in this order, and only what they need. Without tests of
/// pivots: where the function would return 1 the entries may be infinite or not a number.
Function restricted(const Function& function, const std::vector<std::size_t>& entries);

}  // namespace eomgen::program
