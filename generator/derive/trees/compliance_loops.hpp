// SPDX-License-Identifier: GPL-3.0-or-later
// The accelerations of all coordinates of a tree of bodies due to disturbances of every link, as loops over arrays.
// The formulas are those of body_compliance.hpp. A pass of a loop belongs to one disturbance, or to the force on one
// coordinate, and makes the step from a link to the next.
#pragma once

#include "derive/trees/link_dynamics.hpp"
#include "system/array_loops.hpp"

namespace eomgen::derive {

/// Slopes of generalised forces by the coordinates of the same link are symbols (AccelerationSlopes::forces).
system::AccelerationSlopes compliance_loops(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                            const std::vector<LinkDynamics>& dynamics);

}  // namespace eomgen::derive
