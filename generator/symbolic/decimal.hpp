// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion between rationals and decimal text.
#pragma once

#include <string>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Parses "9.81" or "-1e-3" exactly. Errors quote `shown`. Throws Error for other text, more than 400 digits, or an
/// exponent beyond 400.
Rational parse_decimal(const std::string& text, const std::string& shown);

/// "9.81" for 981/100; a fraction if no decimal of at most 17 digits is exact.
std::string decimal_text(const Rational& value);

}  // namespace eomgen::symbolic
