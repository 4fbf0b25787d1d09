// SPDX-License-Identifier: GPL-3.0-or-later
// In: a function of a program. Out: its operations on registers and a scratch array, in the order of the program, with
// the operations and roundings of the emitted C (emit/straight_line.hpp). Values stay in registers until the one whose
// next use is furthest gives way (Belady, 1966: fewest loads).
#pragma once

#include <span>

#include "jit/steps.hpp"
#include "program/program.hpp"

namespace eomgen::jit {

/// `default_inputs`: the inputs of a function that takes none. `free_count`: the number of free coordinates, whose
/// accelerations must be finite. Takes O(instructions) time.
FunctionSteps assign_registers(const program::Function& function, std::span<const double> default_inputs,
                               std::size_t free_count, Constants& constants);

}  // namespace eomgen::jit
