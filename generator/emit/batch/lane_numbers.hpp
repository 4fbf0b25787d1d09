// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar types of lanes: double, or float in single precision.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The dialect of C with lanes; `prefix`: of the functions of templates/batch.
Dialect lane_dialect(bool single, const std::string& prefix);

/// Values for the skeletons of templates/batch: types, lanes per register, tests of all lanes at once.
std::vector<std::pair<std::string, std::string>> lane_template_values(bool single);

}  // namespace eomgen::emit
