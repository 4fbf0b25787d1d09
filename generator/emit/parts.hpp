// SPDX-License-Identifier: GPL-3.0-or-later
// Splitting of long functions, because compile time grows faster than the length of a function.
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The part of each instruction; sines and cosines that are computed together stay in one part.
std::vector<std::size_t> assign_parts(const program::Function& function);

/// Calls "NAME_part2(t, x, .., work)" of every part, with a return if a part does not return 0.
std::string part_calls(const std::string& name, const FunctionText& text, const std::string& arguments,
                       const std::string& real);

}  // namespace eomgen::emit
