// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies and particles that hang on one another, as links whose masses and joints are known along their own axes:
// what positions say as sums of components along the axes of bodies and frames, each place measured from another one.
#pragma once

#include <optional>
#include <vector>

#include "derive/trees/turn.hpp"

namespace eomgen::derive {

/// How a coordinate moves a link against its parent: angular velocity of its axes, velocity of its origin.
struct Freedom {
  std::size_t index;  // in the coordinates that were asked for
  Vec3 turning, shifting;
};

/// Axes with an origin and what is fixed in them. All vectors of a link are along its own axes, but for `offset`.
struct BodyLink {
  int parent = -1;                // index of a link before this one, -1: the ground
  std::uint32_t frame = 0;        // of the model, whose axes these are
  Vec3 offset;                    // from the parent's origin to the own one, along the parent's axes
  Vec3 offset_rate, offset_bias;  // its rate, and that one's at zero second rates
  Turn turn;
  bool relative = true;  // turned against the parent; otherwise along E1, E2, E3 on a parent that turns
  bool absolute =
      false;  // the angular velocity itself stands for the rates of the three (four) coordinates that turn it
  std::vector<Freedom> freedoms;
  std::vector<Freedom> angles;  // of an absolute link: the coordinates, in place of which `freedoms` has the three axes
  std::vector<Ref> parameters;  // Euler parameters and their rates: 4 and 4, in the order of `angles`; none otherwise
  Ref mass;
  Vec3 moment;   // sum of m r
  Mat3 inertia;  // about the origin

  /// The parent's turning carries it along, as far as its velocities (or what stands for them) are its own.
  bool carried() const { return relative && !absolute; }
};

struct BodyTree {
  std::vector<BodyLink> links;  // parents first
  Vec3 gravity;                 // acceleration, of uniform gravity, along E1, E2, E3
  std::vector<Ref> Q;           // all other forces, of the coordinates
};

/// The tree that the coordinates `of` see; with `imposed`, the eliminated coordinates are functions of time. Nothing
/// where the model has no bodies, where a coordinate moves no joint or several, where a mass varies, or kinetic energy
/// is given.
std::optional<BodyTree> body_tree(Mechanics& mechanics, const std::vector<std::uint32_t>& of, bool imposed);

/// Lets the angular velocity of each link that three coordinates, or four Euler parameters, turn stand for their rates.
/// With fewer angular velocities than coordinates some indices are left without a freedom.
void use_angular_velocities(Dag& dag, BodyTree& tree);

}  // namespace eomgen::derive
