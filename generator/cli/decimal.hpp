// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::cli {

/// "9.81", "-1e-3": exactly, as a rational. `shown` is what the error quotes. Throws Error for anything else, also for
/// more than 400 digits or an exponent beyond 400.
symbolic::Rational parse_decimal(const std::string& text, const std::string& shown);

/// --set NAME=VALUE, of two for one name the last. Throws Error{stage `command`} for what sets nothing.
std::map<std::string, symbolic::Rational> parse_assignments(const std::string& command,
                                                            const std::vector<std::string>& assignments);

/// "9.81" for 981/100; the fraction where no decimal of at most 17 digits is it.
std::string decimal_text(const symbolic::Rational& value);

}  // namespace eomgen::cli
