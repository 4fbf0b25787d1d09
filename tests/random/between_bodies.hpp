// SPDX-License-Identifier: GPL-3.0-or-later
// Forces between bodies of a random mechanism: bushings, struts, actuators. In: bodies that rotate. Out: [[force]]
// tables.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "random/random_source.hpp"

namespace eomgen::random_models {

std::string forces_between(RandomSource& dice, const std::vector<std::string>& bodies, bool planar,
                           std::set<std::string>& features);

}  // namespace eomgen::random_models
