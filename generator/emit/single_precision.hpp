// SPDX-License-Identifier: GPL-3.0-or-later
// Code in single precision (emit --real float). In: the context of the same code in double precision. Out: its self
// test at states that are numbers of single precision, and what that costs, which the certificate tells.
#pragma once

#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The unit in the last place of single precision, by that of double precision.
inline constexpr double single_by_double = 536870912;  // 2^29

/// Sets EmissionContext::single_error: how far results are off at the states of the self test, by the largest entry of
/// each array. Throws Error{stage "emit"} where the right-hand side has no value in single precision at any of them.
void make_single(const program::Program& program, EmissionContext& context);

/// The number of single precision that C takes for this one. Throws Error{stage "emit"} where there is none.
double single_number(double value);

/// C in single precision.
Dialect single_dialect();

}  // namespace eomgen::emit
