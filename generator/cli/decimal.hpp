// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "symbolic/dag.hpp"

namespace eomgen::cli {

/// "9.81", "-1e-3": exactly, as a rational. `shown` is what the error quotes. Throws Error for anything else, also for
/// more than 400 digits or an exponent beyond 400.
symbolic::Rational parse_decimal(const std::string& text, const std::string& shown);

/// "9.81" for 981/100; the fraction where no decimal of at most 17 digits is it.
std::string decimal_text(const symbolic::Rational& value);

}  // namespace eomgen::cli
