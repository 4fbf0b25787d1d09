// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of programs and compiled code. In: the subjects and the values of the first system at a state. Out: the
// difference of the program in the same digits, and of the compiled code in binary64 if its rounding error has a bound.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// Compares programs and compiled code with the first system, with the friction forces of the law in `mode`. Throws
/// std::domain_error if the values exceed binary64.
void compare_code(const Subjects& subjects, const SystemValues& values, const Oracle& oracle,
                  const std::vector<int>& mode, ComparisonTable& tally);

}  // namespace eomgen::verify
