// SPDX-License-Identifier: GPL-3.0-or-later
// Rationals from and to decimals.
#pragma once

#include <string>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// "9.81", "-1e-3": exactly, as a rational. `shown` is what the error quotes. Throws Error for anything else, also for
/// more than 400 digits or an exponent beyond 400.
Rational parse_decimal(const std::string& text, const std::string& shown);

/// "9.81" for 981/100; the fraction where no decimal of at most 17 digits is it.
std::string decimal_text(const Rational& value);

}  // namespace eomgen::symbolic
