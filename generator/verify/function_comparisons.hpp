// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of the C ABI functions other than the right-hand side. In: a program and the values of a system at a
// state. Out: the differences of the program's functions from these values.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// Compares the functions of the first program with its right-hand side, with its system, and with the energies.
void compare_functions(const Subjects& subjects, const SystemValues& values, const Oracle& oracle,
                       const std::vector<int>& mode, ComparisonTable& tally);

}  // namespace eomgen::verify
