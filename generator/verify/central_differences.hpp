// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives of the functions of a program by central differences. In: a function, its arguments, a shift of them.
// Out: the derivatives along the shift, with error estimates.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "verify/certificate.hpp"

namespace eomgen::verify {

Real power_of_ten(int exponent);

/// The same numbers with more digits: CLN rounds a sum of floats to the shorter one.
AbiArguments with_digits(const AbiArguments& at, const Precision& precision);

/// The number as an exact rational, so that sums with it keep the digits of the other operand.
Real to_exact(const Real& value);

/// Entry `j` of a fixed direction without zero components.
Real direction_component(std::size_t j);

/// Shifts arguments by `step` along a direction.
using Shift = std::function<void(AbiArguments& at, const Real& step)>;

/// A central difference, for each entry of each array of a function.
struct CentralDifference {
  AbiResults values;  // [f(at + h) - f(at - h)]/2h
  AbiResults errors;  // h times the second differences; if a derivative is as small as its third difference, also h
                      // times that over h^2
};

/// The central difference with h = 10^-digits, in three times the digits; nothing if the function has no values.
std::optional<CentralDifference> central_difference(const ProgramForm& program, const std::string& function,
                                                    const AbiArguments& at, const Shift& shift, int digits);

}  // namespace eomgen::verify
