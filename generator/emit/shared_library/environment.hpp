// SPDX-License-Identifier: GPL-3.0-or-later
// Variables of the environment.
#pragma once

#include <cstdlib>
#include <string>

namespace eomgen::emit {

/// The value of a variable; empty if it is not set.
inline std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace eomgen::emit
