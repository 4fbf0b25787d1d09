// SPDX-License-Identifier: GPL-3.0-or-later
// How the links of a tree of bodies move, and what their joints make of it: angular velocities along their own axes,
// the parts of accelerations that second rates do not enter, and between the angular acceleration of a link and its
// angles.
#pragma once

#include "derive/trees/body_tree.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::derive {

struct LinkMotion {
  Vec3 w;     // angular velocity
  Vec3 bias;  // angular acceleration beside the parent's and the second rates'
  Mat3 W;     // v -> w x (w x v)
  Vec3 lift;  // acceleration of the origin beside that of the parent's axes at rest, along the parent's axes
};

/// One entry per link.
std::vector<LinkMotion> motion_of(Dag& dag, const BodyTree& tree);

/// w x J w of a symmetric J.
Vec3 gyroscopic(Dag& dag, const Mat3& J, const Vec3& w);

/// The moment on an absolute link that does on its rates what the forces Q do on its coordinates.
Vec3 joint_moment(Dag& dag, const BodyLink& link, const std::vector<Ref>& Q);

/// From the rates' derivatives u to those of the coordinates: the same but for absolute links, of which u is the
/// angular acceleration and which add what their angles divide by to `pivots`.
std::vector<Ref> second_rates(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                              const std::vector<Ref>& u, std::vector<symbolic::Pivot>& pivots);

}  // namespace eomgen::derive
