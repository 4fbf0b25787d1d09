// SPDX-License-Identifier: GPL-3.0-or-later
// The recursive Newton-Euler and composite-body algorithms for trees of bodies (Featherstone 2008, ch. 5, 6), on
// expressions: accelerations outwards, forces and composite inertias inwards, all along the axes of the link. If
// angular velocities replace the rates of ball joints, the bodies beyond a joint count as a point mass there, and
// composite inertias are constant.
#pragma once

#include "derive/trees/body_motion.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

struct BodyEquations {
  std::vector<Ref> M, f;  // n x n row-major, n; for the rates or the angular velocities in their place
};

/// Mass, first moment of mass and inertia of a link and of all links beyond it, about the origin of the link.
struct Composite {
  Ref mass;
  Vec3 moment;
  Mat3 inertia;
};

/// One entry per link.
std::vector<Composite> composite_bodies(Dag& dag, const BodyTree& tree);

/// M and f with M qddot = f, or M (qddot - given) = f with other accelerations than 0.
BodyEquations body_equations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                             const std::vector<BiasAcceleration>& bias);

}  // namespace eomgen::derive
