// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of the links of a tree of bodies: angular velocities along their own axes, the velocity-dependent parts of
// accelerations (bias), and the relation between the angular acceleration of a link and its angles.
#pragma once

#include <utility>

#include "derive/trees/body_tree.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::derive {

struct LinkMotion {
  Vec3 w;           // angular velocity
  Vec3 bias;        // angular acceleration without the parts of the parent and of qddot
  Mat3 W;           // v -> w x (w x v)
  Vec3 slide_bias;  // acceleration of the origin in the axes of the parent, and Coriolis's, along these axes
};

/// One entry per link.
std::vector<LinkMotion> link_motions(Dag& dag, const BodyTree& tree);

/// The accelerations of a link along its axes, at given accelerations of the coordinates: angular, of the origin less
/// gravity, and U: r -> alpha x r + w x (w x r).
struct BiasAcceleration {
  Vec3 alpha, a;
  Mat3 U;
  Ref joint;  // the given acceleration of the only freedom
};

/// The accelerations that are given: all 0, or those of pins and sliders at which the link's own vanishes along the
/// joint, which saves products.
enum class GivenAccelerations { zero, without_own };

/// One entry per link.
std::vector<BiasAcceleration> bias_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                                 GivenAccelerations given);

/// The moment about the origin and the force that a link needs for these accelerations.
std::pair<Vec3, Vec3> needed_forces(Dag& dag, const BodyLink& link, const LinkMotion& motion,
                                    const BiasAcceleration& bias);

/// The index of the axis k if v is the unit vector along it; otherwise 3.
std::size_t unit_axis(const Dag& dag, const Vec3& v);

/// The moment on an absolute link that is equivalent to the forces Q on its coordinates.
Vec3 joint_moment(Dag& dag, const BodyLink& link, const std::vector<Ref>& Q);

/// The force on the origin of a free link along its own axes.
Vec3 force_on_origin(Dag& dag, const BodyLink& link, const std::vector<Ref>& Q);

/// Converts the derivatives u of the rates to those of the coordinates. They differ for absolute links only, where u is
/// the angular acceleration. The divisors of their angles are appended to `pivots`.
std::vector<Ref> coordinate_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                          const std::vector<Ref>& u, std::vector<symbolic::Pivot>& pivots);

}  // namespace eomgen::derive
