// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "symbolic/decimal.hpp"

namespace eomgen::cli {

using symbolic::decimal_text;
using symbolic::parse_decimal;

/// Parses NAME=VALUE arguments of `option`; the last one of a name counts. Throws Error{stage `command`} for anything
/// else.
std::map<std::string, symbolic::Rational> parse_assignments(const std::string& command, const std::string& option,
                                                            const std::vector<std::string>& assignments);

}  // namespace eomgen::cli
