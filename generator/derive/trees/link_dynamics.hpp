// SPDX-License-Identifier: GPL-3.0-or-later
// The links of a tree of bodies at given accelerations (the second derivatives of the coordinates as symbols): their
// motion, the forces that they need, and how a coordinate or its rate disturbs the motion of a link whose parent moves
// as before (docs/theory.md, "Derivatives of the right-hand side"). Vectors of a link are along its own axes.
#pragma once

#include "derive/trees/body_motion.hpp"

namespace eomgen::derive {

/// The disturbance of a link and of all links beyond it, at fixed coordinates there: of the angular velocity, and of
/// the accelerations without the part that a rotating base causes, dalpha - domega x omega and that of the origin.
struct Disturbance {
  Vec3 omega, alpha, a;
};

struct Wrench {
  Vec3 moment, force;  // about the origin of the link
};

/// Twice the linear momentum sum m u, and twice sum m u r^T, with places r from the origin and velocities u.
struct Flow {
  Vec3 momentum;
  Mat3 matrix;

  /// The moment needed where the base rotates faster: of the angular velocity of the disturbance.
  Vec3 moment(Dag& dag, const Vec3& omega) const;
};

/// Changes that a coordinate of a link causes, at a parent that moves as before.
struct FreedomChange {
  Disturbance by_q, by_qdot;
  std::vector<Freedom> directions;  // d/dq of every freedom of the link
  Vec3 slide;                       // d/dq of the offset, along the parent's axes
};

struct LinkDynamics {
  Wrench wrench;                       // needed by the link and all links beyond it
  Flow flow;                           // of the link alone, with velocities relative to the origin
  std::vector<FreedomChange> changes;  // per freedom
};

/// One entry per link. No link is absolute, and every link rotates relative to its parent.
std::vector<LinkDynamics> link_dynamics(Mechanics& mechanics, const BodyTree& tree,
                                        const std::vector<LinkMotion>& motion);

Ref along(Dag& dag, const Freedom& freedom, const Wrench& wrench);
/// The same wrench about the parent's origin, along its axes.
Wrench to_parent(Dag& dag, const BodyLink& link, const Wrench& wrench);

}  // namespace eomgen::derive
