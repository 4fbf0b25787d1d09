// SPDX-License-Identifier: GPL-3.0-or-later
// Long functions in parts: a compiler's time grows faster than the length of a function.
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Which part each instruction is in; sines and cosines that are computed together stay so.
std::vector<std::size_t> parts_of(const program::Function& function);

/// "NAME_part2(t, x, .., work)" for every part, and what returns where one of them does not return 0.
std::string calls_of_parts(const std::string& name, const FunctionText& text, const std::string& arguments,
                           const std::string& real);

}  // namespace eomgen::emit
