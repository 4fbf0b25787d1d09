// SPDX-License-Identifier: GPL-3.0-or-later
// Starts of points that follow the rim of a disk: the nearest one may be anywhere along it. In: a StartProblem, the
// ranges of its coordinates. Out: the start from the first of eight angles with which the coordinates are in range.
#pragma once

#include <vector>

#include "run/start.hpp"

namespace eomgen::run {

/// As solve_start(). lower, upper: open ranges, one entry per coordinate. Angles that the scene gives or guesses stay.
/// If no angle serves, the start is that of solve_start().
void solve_start_on_rims(StartProblem& problem, const std::vector<double>& lower, const std::vector<double>& upper);

}  // namespace eomgen::run
