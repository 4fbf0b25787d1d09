// SPDX-License-Identifier: GPL-3.0-or-later
// Printing of loops over arrays (program/array_program.hpp) as statements of C or C++.
#pragma once

#include <string>

#include "emit/straight_line.hpp"
#include "program/array_program.hpp"

namespace eomgen::emit {

/// The body of `jac` of `states` states. `scalars`: the function for the scalars, whose arguments but the last are
/// `arguments`.
std::string print_loops(const program::ArrayProgram& program, std::size_t states, const Dialect& dialect,
                        const std::string& scalars, const std::string& arguments);

}  // namespace eomgen::emit
