// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of rigid bodies and particles as links whose masses and joints are known along their own axes. It is read from
// positions that are sums of components along the axes of bodies and frames, each measured from another place.
#pragma once

#include <optional>
#include <vector>

#include "derive/trees/rotation_sequence.hpp"

namespace eomgen::derive {

/// The motion of a link relative to its parent per coordinate rate: angular velocity of its axes, velocity of its
/// origin.
struct Freedom {
  std::size_t index;  // into the requested coordinates
  Vec3 angular, linear;
};

/// Axes with an origin, and the masses fixed in them. All vectors of a link are along its own axes, except `offset`.
struct BodyLink {
  int parent = -1;                // index of a link before this one, -1: the ground
  std::uint32_t frame = 0;        // of the model; its axes
  Vec3 offset;                    // from the parent's origin to the own one, along the parent's axes
  Vec3 offset_rate, offset_bias;  // its rate, and the derivative of that rate at zero qddot
  RotationSequence rotation;
  bool relative = true;   // axes relative to the parent; otherwise E1, E2, E3 on a rotating parent
  bool absolute = false;  // the angular velocity replaces the rates of its three (four) coordinates of rotation
  bool free = false;      // and the acceleration of the origin less gravity, along the own axes, those along E1, E2, E3
  std::vector<Freedom> freedoms;
  std::vector<Freedom> angles;  // of an absolute link: its coordinates, which the three axes replace in `freedoms`
  std::vector<Ref> parameters;  // 4 Euler parameters, then their 4 rates, in the order of `angles`; otherwise empty
  Ref mass;
  Vec3 moment;   // sum of m r
  Mat3 inertia;  // about the origin

  /// Whether the parent's rotation carries the link, as its rates are relative to the parent.
  bool is_carried_by_parent() const { return relative && !absolute; }
};

struct BodyTree {
  std::vector<BodyLink> links;  // parents first
  Vec3 gravity;                 // acceleration, of uniform gravity, along E1, E2, E3
  std::vector<Ref> Q;           // all other generalised forces
  std::vector<Ref> armature;    // per coordinate: a constant a of the kinetic energy a qdot^2/2 beside the bodies
};

/// The tree for the coordinates `of`. With `imposed`, the eliminated coordinates are functions of time. Empty if the
/// model has no bodies, if a coordinate moves no joint or several, if a mass varies, or if kinetic energy is given that
/// is no sum of constants times squares of rates.
std::optional<BodyTree> body_tree(Mechanics& mechanics, const std::vector<std::uint32_t>& of, bool imposed);

/// Replaces the rates of three angles, or of four Euler parameters, of a link by its angular velocity. With fewer
/// angular velocities than coordinates, some indices have no freedom.
void use_angular_velocities(Dag& dag, BodyTree& tree);

}  // namespace eomgen::derive
