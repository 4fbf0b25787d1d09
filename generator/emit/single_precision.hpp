// SPDX-License-Identifier: GPL-3.0-or-later
// Code in single precision (emit --real float). In: the context of the same code in double precision. Out: its
// self-test at states that are single-precision numbers, and the loss of accuracy, which the certificate reports.
#pragma once

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The ratio of the unit in the last place of single precision to that of double precision.
inline constexpr double single_to_double_ulp = 536870912;  // 2^29

/// Sets EmissionContext::single_error: the largest error at the states of the self-test, relative to the largest entry
/// of each array. Throws Error{stage "emit"} if the right-hand side has no value in single precision at any of them.
void convert_to_single(const program::Program& program, EmissionContext& context);

/// The number to which C rounds this one in single precision. Throws Error{stage "emit"} if it overflows.
double to_single(double value);

/// The dialect of C in single precision.
Dialect single_dialect();

}  // namespace eomgen::emit
