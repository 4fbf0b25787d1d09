// SPDX-License-Identifier: GPL-3.0-or-later
// Arguments of the functions of a program: of the ABI (abi/functions.hpp), and internal ones of charts and of Taylor
// series.
#pragma once

#include <string>
#include <vector>

#include "abi/functions.hpp"
#include "program/program.hpp"

namespace eomgen::program {

/// The inputs of a function, in the order of its arguments.
std::vector<abi::Input> inputs_of(const std::string& function);

/// Whether a function reads inputs from an argument. Functions of the state without that argument use the defaults.
bool takes_inputs(const std::string& function);

/// The number of entries of the argument v; 0 for functions without it.
std::size_t vector_size(const std::string& function, const Program& program);
/// The largest of them; 0 if no function of the program takes v.
std::size_t vector_size(const Program& program);

/// Whether a caller may leave out a result array.
bool may_be_null(const std::string& function, std::size_t result);

}  // namespace eomgen::program
