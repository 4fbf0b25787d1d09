// SPDX-License-Identifier: GPL-3.0-or-later
// Sides of kinks for a state that lies on their surfaces. In: the equations of a run, a state, states beside it. Out:
// the branches of the motion that starts there, as the limit of short times, and whether motions beside it differ.
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

/// A state beside that of the run, in the scene to which it belongs.
struct StateBeside {
  VariationalEquations* in;
  double t;
  std::vector<double> x;
};

/// Whether the derivatives of the motion that starts at (t, x), on the surface of a kink after leave_surfaces(), differ
/// between the two directions of a change. beside: the changed states in the order of difference_offsets(). They do
/// where a change leads to the other side of a surface at which f jumps: from there the motion crosses the surface. A
/// motion that stays on the surface also shows a jump of df/dx.
bool differs_beside(VariationalEquations& in, std::size_t kink, double t, const std::vector<double>& x, double span,
                    const std::vector<StateBeside>& beside);

/// Whether f jumps between its values on the two sides of a surface by more than rounding.
bool has_jump(const std::vector<double>& before, const std::vector<double>& after);

}  // namespace eomgen::run
