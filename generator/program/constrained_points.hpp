// SPDX-License-Identifier: GPL-3.0-or-later
// Points at which constraints hold. What vanishes exactly there, and not elsewhere, cannot be divided by: the moment
// arms of a ball joint, say, about the very point that it holds.
#pragma once

#include <map>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::program {

using Point = std::map<symbolic::Symbol, double>;  // the symbols of what was asked for

/// Values of the symbols in A[rows] and psi[rows] with psi[rows] = 0 to rounding, at up to four points: of coordinates,
/// or of parameters too where those alone do not do it (lengths that do not close). None of rows that are constraints
/// on velocities alone, or where the search finds none: that says nothing. The same in every process.
std::vector<Point> points_on_constraints(const system::EquationSystem& system, const std::vector<std::size_t>& rows);

}  // namespace eomgen::program
