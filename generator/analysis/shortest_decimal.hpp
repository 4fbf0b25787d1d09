// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>

#include "symbolic/decimal.hpp"

namespace eomgen::analysis {

/// Returns, as an exact rational, the shortest decimal that reads back as this binary64; tables print the same decimal.
/// Errors quote `name`.
inline symbolic::Rational shortest_decimal(double value, const std::string& name) {
  return symbolic::parse_decimal(fmt::format("{}", value == 0 ? 0.0 : value), name);
}

}  // namespace eomgen::analysis
