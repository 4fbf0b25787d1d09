// SPDX-License-Identifier: GPL-3.0-or-later
// Calls of the parts of long functions (program/parts.hpp).
#pragma once

#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Calls "NAME_part2(t, x, .., work)" of every part, with a return if a part does not return 0.
std::string part_calls(const std::string& name, const FunctionText& text, const std::string& arguments,
                       const std::string& real);

}  // namespace eomgen::emit
