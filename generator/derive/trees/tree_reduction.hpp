// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of bodies with the same equations of motion and fewer operations.
#pragma once

#include "derive/trees/body_tree.hpp"

namespace eomgen::derive {

/// Links that do not move relative to their parents join them, and inertias are regrouped: the parent gets what a pin
/// joint does not feel, which is the mass, and the first and second moment along the axis (minimal inertial parameters:
/// Khalil and Dombre, Modeling, Identification and Control of Robots, 2002, ch. 9). Masses of links may become 0.
/// Origins of pins move along their axes to where the offset from the parent has no component along them.
BodyTree with_regrouped_inertias(Dag& dag, BodyTree tree);

/// Trees with the same equations of motion: the tree itself, with regrouped inertias, and both of these ways with
/// shared axes. Pins before the end of a branch, with parallel axes beyond them, get the axes of their parents; with
/// them or not, also the pins at the end. There the constants of the link rotate, in place of its remaining inertia
/// after an elimination, and parallel pins rotate by the sum of their angles.
std::vector<BodyTree> equivalent_trees(Dag& dag, const BodyTree& tree);

/// Solves bodies that move freely for the accelerations along their own axes, which replace the second derivatives of
/// three Cartesian coordinates. Requires angular velocities (`use_angular_velocities`). Empty if there are none.
std::optional<BodyTree> along_own_axes_of_free_bodies(Dag& dag, BodyTree tree);

/// Sums, products and quotients in expressions.
std::size_t count_operations(const Dag& dag, const std::vector<Ref>& roots);

}  // namespace eomgen::derive
