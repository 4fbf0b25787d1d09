// SPDX-License-Identifier: GPL-3.0-or-later
// Programs and compiled code. In: the subjects, and the values of the first system at a state. Out: how far the program
// is from it in the same digits, and compiled code in binary64, where what rounding may do there is known.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// Programs and compiled code against the first system, whose friction forces are those of the law in `mode`. Throws
/// std::domain_error where binary64 holds nothing that could be compared.
void compare_code(const Subjects& subjects, const SystemValues& values, const Judge& judge, int mode, Tally& tally);

}  // namespace eomgen::verify
