// SPDX-License-Identifier: GPL-3.0-or-later
// The articulated-body scheme for trees of bodies (Featherstone 2008, ch. 7), on expressions: from the tips inwards
// each joint's second rates are eliminated, and what is left of a link's inertia passes to its parent: six by six, or
// three by three of a point through a ball joint. No mass matrix of the whole is formed.
#pragma once

#include "derive/trees/body_motion.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Derivatives of the rates, or of what stands for them, and the pivots.
system::Solution body_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion);

}  // namespace eomgen::derive
