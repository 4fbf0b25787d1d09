// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that lanes are made of: doubles, or floats in single precision.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// C in lanes; `prefix`: of the functions of templates/batch.
Dialect dialect_of_lanes(bool single, const std::string& prefix);

/// What the skeletons of templates/batch say of them: types, lanes of registers, tests of all lanes at once.
std::vector<std::pair<std::string, std::string>> values_of_lanes(bool single);

}  // namespace eomgen::emit
