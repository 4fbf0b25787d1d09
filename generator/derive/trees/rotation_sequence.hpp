// SPDX-License-Identifier: GPL-3.0-or-later
// Transforms components of vectors and matrices between the axes of adjacent links. Rotations are applied step by step,
// which costs less than their product if each step is about one axis.
#pragma once

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

}  // namespace eomgen::derive
