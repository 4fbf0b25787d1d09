// SPDX-License-Identifier: GPL-3.0-or-later
// In: a Function and a state. Out: how far binary64 may be from the exact value of each result there, as a bound to
// first order: every operation rounds by half a unit in the last place, the C library's functions by two, and what they
// are given is off by what came before. The bound is what tells rounding apart from wrong code where terms cancel or
// angles are large.
#pragma once

#include <vector>

#include "program/interpret.hpp"

namespace eomgen::program {

/// 2^-53: half a unit in the last place of 1.
inline constexpr double half_unit = 0x1p-53;

/// One list per Function::results; `w_off`: how far the prepared values are off. Infinite where a branch may be the
/// other one, or there is no value.
std::vector<std::vector<double>> rounding_bounds(const Function& function, const Arguments<double>& arguments,
                                                 const std::vector<double>& w_off = {});

}  // namespace eomgen::program
