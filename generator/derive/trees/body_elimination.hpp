// SPDX-License-Identifier: GPL-3.0-or-later
// The articulated-body algorithm for trees of bodies (Featherstone 2008, ch. 7), on expressions. From the tips inwards,
// each joint's accelerations are eliminated, and the remaining inertia of a link passes to its parent: 6 x 6, or 3 x 3
// of a point through a ball joint. No mass matrix of the whole is formed.
#pragma once

#include "derive/trees/body_motion.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// The derivatives of the rates (or of the angular velocities in their place), and the pivots.
system::Solution body_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion);

}  // namespace eomgen::derive
