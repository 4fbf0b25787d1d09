// SPDX-License-Identifier: MIT
// Formatting of numbers in the sentences of results.
#pragma once

#include <cstdio>
#include <string>

namespace eom::hybrid {

/// The number with `digits` significant digits; 17 reproduce it exactly.
inline std::string printed(double value, int digits = 17) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace eom::hybrid
