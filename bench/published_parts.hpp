// SPDX-License-Identifier: GPL-3.0-or-later
// Common part of the files of the published problems.
#pragma once

#include <string>

#include "published_equations.hpp"

namespace published {

inline Quad at(const Values& values, const std::string& name) { return values.at(name); }

Problem andrews();
Problem car_axis();

}  // namespace published
