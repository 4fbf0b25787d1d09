// SPDX-License-Identifier: GPL-3.0-or-later
// Points that satisfy the constraints. An expression that vanishes exactly there, and only there, must not be a
// divisor. Example: the moment arms of a ball joint about its own centre.
#pragma once

#include <map>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::program {

using Point = std::map<symbolic::Symbol, double>;  // values of the symbols in the requested rows

/// Up to four points with psi[rows] = 0 to rounding, as values of the symbols in A[rows] and psi[rows]. The search
/// varies coordinates, and also parameters if coordinates alone are not enough (lengths that do not close). The result
/// is empty for rows that constrain velocities only, and if the search fails; then nothing is known. The result is the
/// same in every process.
std::vector<Point> points_on_constraints(const system::EquationSystem& system, const std::vector<std::size_t>& rows);

}  // namespace eomgen::program
