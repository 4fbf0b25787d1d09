// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "symbolic/decimal.hpp"

namespace eomgen::cli {

using symbolic::decimal_text;
using symbolic::parse_decimal;

/// NAME=VALUE behind `option`, of two for one name the last. Throws Error{stage `command`} for what sets nothing.
std::map<std::string, symbolic::Rational> parse_assignments(const std::string& command, const std::string& option,
                                                            const std::vector<std::string>& assignments);

}  // namespace eomgen::cli
