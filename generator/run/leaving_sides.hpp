// SPDX-License-Identifier: GPL-3.0-or-later
// Sides of kinks for a state that lies on their surfaces. In: the equations of a run, a state. Out: the branches of the
// motion that starts there, as the limit of short times.
//
// A branch that follows the state has the value on the surface at the first stage of the first step, and at the end of
// an integration backward. There sign(g) = 0, and if(g < 0, a, b) may be the branch of the other side.
#pragma once

#include <cstddef>
#include <vector>

#include "run/variational_equations.hpp"

namespace eomgen::run {

/// Freezes each kink on the surface of which the state lies, up to rounding, on the side to which the motion leaves the
/// surface. A kink stays without a side if the motion stays on its surface, or may leave it to several sides. span:
/// of the run. Returns these kinks, with and without sides.
std::vector<std::size_t> leave_surfaces(VariationalEquations& in, double t, const std::vector<double>& x, double span);

}  // namespace eomgen::run
