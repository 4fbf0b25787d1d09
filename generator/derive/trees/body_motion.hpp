// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of the links of a tree of bodies: angular velocities along their own axes, the velocity-dependent parts of
// accelerations (bias), and the relation between the angular acceleration of a link and its angles.
#pragma once

#include "derive/trees/body_tree.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::derive {

struct LinkMotion {
  Vec3 w;     // angular velocity
  Vec3 bias;  // angular acceleration without the parts of the parent and of qddot
  Mat3 W;     // v -> w x (w x v)
  Vec3
      origin_bias;  // acceleration of the origin at zero alpha, a of the parent and zero qddot, along the parent's axes
};

/// One entry per link.
std::vector<LinkMotion> link_motions(Dag& dag, const BodyTree& tree);

/// w x J w of a symmetric J.
Vec3 gyroscopic(Dag& dag, const Mat3& J, const Vec3& w);

/// The moment on an absolute link that is equivalent to the forces Q on its coordinates.
Vec3 joint_moment(Dag& dag, const BodyLink& link, const std::vector<Ref>& Q);

/// Converts the derivatives u of the rates to those of the coordinates. They differ for absolute links only, where u is
/// the angular acceleration. The divisors of their angles are appended to `pivots`.
std::vector<Ref> coordinate_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                          const std::vector<Ref>& u, std::vector<symbolic::Pivot>& pivots);

}  // namespace eomgen::derive
