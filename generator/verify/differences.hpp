// SPDX-License-Identifier: GPL-3.0-or-later
// Slopes of the functions of a program by central differences. In: a function, its arguments, how they are shifted.
// Out: the slopes along the shift, with what they may be off by.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "verify/certificate.hpp"

namespace eomgen::verify {

Real ten_to(int exponent);

/// The same numbers with more digits: a sum of floats has those of the shorter one.
At with_digits(const At& at, const Precision& precision);

/// A number without a format of its own: in sums of more digits a float of fewer takes them away.
Real exactly(const Real& value);

/// Entry `j` of a direction without zeros, the same everywhere.
Real component(std::size_t j);

/// Moves arguments by `step` along a direction.
using Shift = std::function<void(At& at, const Real& step)>;

/// Per entry of each array of a function.
struct Slope {
  Arrays values;  // [f(at + h) - f(at - h)]/2h
  Arrays errors;  // h times the second differences, which is all there is of a body that is held fast; where a slope is
                  // as small as its own third differences, h times these over h^2 too
};

/// With h = 10^-digits, at three times the digits; nothing where the function has no values.
std::optional<Slope> slope(const ProgramForm& program, const std::string& function, const At& at, const Shift& shift,
                           int digits);

}  // namespace eomgen::verify
