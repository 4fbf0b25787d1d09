// SPDX-License-Identifier: GPL-3.0-or-later
// The articulated-body algorithm for trees of bodies (Featherstone 2008, ch. 7), on expressions. From the tips inwards,
// each joint's accelerations are eliminated, and the remaining inertia of a link passes to its parent: 6 x 6, or 3 x 3
// of a point through a ball joint. No mass matrix of the whole is formed.
#pragma once

#include "derive/trees/body_motion.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// N = I alpha + H a + n, F = H^T alpha + M a + f: the moment about the origin and the force required by a link and all
/// links beyond it.
struct Articulated {
  Mat3 I, H, M;
  Vec3 n, f;
};

/// The equation of one eliminated acceleration: u = (r - N.alpha - F.a)/D.
struct Eliminated {
  Vec3 angular, linear;
  Ref r, D;
  Vec3 N, F;
  std::size_t index;
};

/// One entry per link: its inertia after its own accelerations are eliminated, and their equations in the order of its
/// freedoms.
struct ArticulatedTree {
  std::vector<Articulated> reduced;
  std::vector<std::vector<Eliminated>> eliminated;
};

ArticulatedTree articulated_bodies(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion);

/// The derivatives of the rates (or of the angular velocities in their place), and the pivots.
system::Solution body_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion);

}  // namespace eomgen::derive
