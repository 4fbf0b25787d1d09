// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of the C ABI functions other than the right-hand side. In: a program and the values of a system at a
// state. Out: the differences of the program's functions from these values.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// The arguments of a function of the ABI at the state of `values`.
AbiArguments arguments_at(const system::EquationSystem& system, const State& state, const std::vector<int>& mode);

/// Compares the functions of the first program with its right-hand side, with its system, and with the energies.
void compare_functions(const Subjects& subjects, const SystemValues& values, const Oracle& oracle,
                       const std::vector<int>& mode, ComparisonTable& tally);

/// The scale of an entry that corresponds to its rounding error: the first-order bound over 2^-53.
Real rounding_scale(double bound, const Precision& precision);

}  // namespace eomgen::verify
