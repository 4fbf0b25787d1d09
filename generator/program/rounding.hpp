// SPDX-License-Identifier: GPL-3.0-or-later
// In: a Function and a state. Out: first-order bounds of the rounding errors of its results in binary64. Each operation
// rounds by half a unit in the last place, functions of the C library by two, and errors of operands propagate. The
// bounds distinguish rounding from wrong code if terms cancel or angles are large.
#pragma once

#include <vector>

#include "program/interpret.hpp"

namespace eomgen::program {

/// Unit roundoff of binary64: 2^-53, half a unit in the last place of 1.
inline constexpr double unit_roundoff = 0x1p-53;

/// One list per Function::results; `w_error`: errors of the prepared values. A bound is infinite if rounding may select
/// another branch, or if there is no value.
std::vector<std::vector<double>> rounding_bounds(const Function& function, const Arguments<double>& arguments,
                                                 const std::vector<double>& w_error = {});

}  // namespace eomgen::program
