// SPDX-License-Identifier: GPL-3.0-or-later
// Poses and inertias of rigid bodies in exact digits where rotations permute axes.
// Equations: R = Rz(yaw) Ry(pitch) Rx(roll); J' = R J R^T; J_O = J_C + m (d.d 1 - d d^T).
#pragma once

#include <array>
#include <optional>

#include "import/number.hpp"

namespace eomgen::import {

using Vector = std::array<Number, 3>;
using Matrix = std::array<Vector, 3>;  // rows

Matrix identity();
Vector operator+(const Vector& a, const Vector& b);
Vector operator-(const Vector& a, const Vector& b);
Vector operator*(const Matrix& a, const Vector& v);
Matrix operator*(const Matrix& a, const Matrix& b);
Matrix transposed(const Matrix& a);
bool is_zero(const Vector& v);
bool is_identity(const Matrix& a);

/// The rotation by roll, pitch and yaw, in radians, about the fixed axes x, y, z. Multiples of pi/2 give exact entries.
Matrix rotation(const Vector& rpy);
/// Roll, pitch and yaw of a rotation. A product of rotations about one axis keeps multiples of pi/12.
Vector angles_of(const Matrix& R);

/// A place and axes relative to others: x = R x' + p.
struct Pose {
  Vector p;
  Matrix R = identity();
  std::optional<Vector> rpy = Vector{};  // as written; empty after a product of two rotations

  Vector angles() const { return rpy ? *rpy : angles_of(R); }
};
Pose operator*(const Pose& a, const Pose& b);

/// Mass, centre of mass, and the tensor about it along the axes in which both are given.
struct Inertia {
  Number mass;
  Vector centre;
  Matrix tensor;

  bool is_zero() const;
};
Inertia operator*(const Pose& pose, const Inertia& inertia);
/// Of two bodies that are rigidly connected.
Inertia operator+(const Inertia& a, const Inertia& b);

/// Whether a symmetric matrix has no negative eigenvalue beyond the roundings of six digits.
bool is_positive_semidefinite(const Matrix& a);
/// Whether a body of positive density can have this tensor: no principal moment exceeds the sum of the other two.
bool satisfies_triangle_inequality(const Matrix& tensor);

}  // namespace eomgen::import
