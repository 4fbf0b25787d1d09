// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the C ABI beside the right-hand side. In: a program, with the values of a system at a state. Out:
// how far the program's functions are from what they are functions of.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// The arguments of a function of the ABI at the state of `values`.
At arguments_at(const system::EquationSystem& system, const State& state, int mode);

/// Those of the first program, against its right-hand side, the system that it is made of, and its energies.
void compare_functions(const Subjects& subjects, const SystemValues& values, const Judge& judge, int mode,
                       Tally& tally);

/// What rounding may change in an entry, as a size of what is summed: its first-order bound over 2^-53.
Real size_of_rounding(double bound, const Precision& precision);

}  // namespace eomgen::verify
