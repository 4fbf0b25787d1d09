// SPDX-License-Identifier: GPL-3.0-or-later
// The recursive scheme for trees of bodies (Featherstone 2008, ch. 5, 6), on expressions: accelerations outwards,
// forces and composite inertias inwards, every quantity along the axes of its link. Where angular velocities stand for
// the rates of ball joints, what hangs on a joint counts as a point mass there: composite inertias are constant.
#pragma once

#include "derive/trees/body_motion.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

struct BodyEquations {
  std::vector<Ref> M, f;  // n x n row-major, n; of the rates or what stands for them
};

BodyEquations body_equations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion);

}  // namespace eomgen::derive
