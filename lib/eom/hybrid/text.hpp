// SPDX-License-Identifier: MIT
// Numbers in the sentences that results carry.
#pragma once

#include <cstdio>
#include <string>

namespace eom::hybrid {

/// With so many significant digits; 17 give the number back.
inline std::string printed(double value, int digits = 17) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace eom::hybrid
