// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of rigid bodies and particles as links whose masses and joints are known along their own axes. It is read from
// positions that are sums of components along the axes of bodies and frames, each measured from another place.
#pragma once

#include <optional>
#include <vector>

#include "derive/imposition.hpp"

namespace eomgen::derive {

using Mat3 = std::array<Vec3, 3>;  // rows

Mat3 zero_matrix(const Dag& dag);
Mat3 transposed(const Mat3& a);
Vec3 times(Dag& dag, const Mat3& a, const Vec3& v);
Mat3 product(Dag& dag, const Mat3& a, const Mat3& b);
Mat3 add(Dag& dag, const Mat3& a, const Mat3& b);
/// [d x]: v -> d x v.
Mat3 cross_matrix(Dag& dag, const Vec3& d);

/// One step of the rotation from the axes of a parent to those of a link: e_k = sum_j R_kj p_j. Steps about one axis
/// have the components of their angular velocity.
struct RotationStep {
  Mat3 R;
  Vec3 w, w_bias;  // along the axes after the step; its rate at zero qddot
};

/// Transforms components of vectors and matrices between the axes of adjacent links. Rotations are applied step by
/// step, which costs less than their product if each step is about one axis.
class RotationSequence {
 public:
  std::vector<RotationStep> steps;

  Vec3 to_own_axes(Dag& dag, Vec3 v) const;
  Vec3 to_parent(Dag& dag, Vec3 v) const;
  /// R^T A R of a matrix along the link's axes; symmetric ones stay symmetric.
  Mat3 to_parent(Dag& dag, Mat3 a, bool symmetric) const;
  /// The inverse rotation.
  RotationSequence reversed() const;
};

/// The axis of a step's rotation, if it is one of the three: otherwise 3.
std::size_t axis_of(const Dag& dag, const Mat3& R);

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
