// SPDX-License-Identifier: GPL-3.0-or-later
// Components of vectors and matrices along the axes of one link and of the next: rotations applied step by step, which
// for steps about one axis each costs less than their product does.
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

/// From the axes of a parent to own ones: e_k = sum_j R_kj p_j, step by step. Steps that turn about one axis come with
/// the components of their angular velocity.
struct Step {
  Mat3 R;
  Vec3 w, w_bias;  // along the axes after the step; its rate at zero second rates
};

class Turn {
 public:
  std::vector<Step> steps;

  Vec3 to_own(Dag& dag, Vec3 v) const;
  Vec3 to_parent(Dag& dag, Vec3 v) const;
  /// R^T A R of a matrix along the own axes; symmetric ones stay so.
  Mat3 to_parent(Dag& dag, Mat3 a, bool symmetric) const;
  /// The way back.
  Turn reversed() const;
};

/// The axis that a step turns about, if it is one of the three: 3 otherwise.
std::size_t axis_of(const Dag& dag, const Mat3& R);

}  // namespace eomgen::derive
