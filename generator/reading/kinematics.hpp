// SPDX-License-Identifier: GPL-3.0-or-later
// Kinematics of every particle, body, point, frame and definition, along axes that belong to it and along the fixed
// axes. In: Mechanics. Out: r, v, a; angular velocities, eq. (5.59), Euler and dual Euler bases, eqs. (5.86), (5.87);
// inertia and Euler tensors; angular momenta about the centre of mass, H = J w.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reading/reading.hpp"

namespace eomgen::reading {

/// Three orthonormal vectors.
struct Axes {
  enum class Kind {
    fixed,                 // E1 E2 E3
    own,                   // e1 e2 e3 of `frame`
    before_last_rotation,  // of `frame`: they carry its inertia tensor while it turns about one of them
    chart,                 // unit vectors of coordinates
  };
  Kind kind = Kind::fixed;
  std::uint32_t frame = 0;
  std::vector<std::optional<std::uint32_t>> coordinates;  // of a chart: whose e_q each is
};

enum class Quantity {
  axis,  // `number` k: e_(k+1) of its own axes; 3 + k: of the axes before its last rotation
  position,
  velocity,
  acceleration,
  angular_velocity,
  angular_acceleration,
  tangent,  // d omega/d qdot of the coordinate `number`
  dual,     // g^i of the coordinate `number`: g^i . g_k is 1 if i = k, else 0
  angular_momentum,
  definition,
};
const char* name(Quantity quantity);  // "angular velocity"

/// One vector along one set of axes.
struct KinematicVector {
  Quantity quantity = Quantity::position;
  std::uint32_t index = 0;   // of the place, the frame or the definition
  std::uint32_t number = 0;  // of the axis or the coordinate
  Axes axes;
  Components components;
  std::string skip_reason;  // why the components are omitted; empty if they are present
};

/// A symmetric tensor along one set of axes.
struct KinematicTensor {
  bool is_euler_tensor = false;  // E = tr(J)/2 1 - J; otherwise J
  std::uint32_t about = 0;       // the place to which J refers; 0: the centre of mass
  std::uint32_t frame = 0;
  Axes axes;
  std::array<Components, 3> entries;
  std::string skip_reason;
};

struct KinematicScalar {
  std::uint32_t definition = 0;
  Sum value;
  std::string skip_reason;
};

/// Angle p and axis r of the rotation that maps E1, E2, E3 to the axes of a frame, eq. (5.32).
struct KinematicAngle {
  std::uint32_t frame = 0;
  Sum cosine;                // cos(p) = (tr Q - 1)/2
  Components axis;           // 2 sin(p) r, or r if `angle` is known
  std::optional<Sum> angle;  // p in [0, pi], of a constant attitude
  std::string skip_reason;
};

/// All results of one particle, body, point, frame or definition.
struct Kinematics {
  std::string name;
  std::vector<KinematicVector> vectors;
  std::vector<KinematicTensor> tensors;
  std::optional<KinematicAngle> angle;
  std::optional<KinematicScalar> scalar;
};

/// In the order of the model: places with their bodies, other frames, definitions.
std::vector<Kinematics> kinematics(const mechanics::Mechanics& mechanics);

/// The Euler and dual Euler bases of bodies and frames alone, (5.86), (5.87): `tangent` and `dual` vectors.
std::vector<Kinematics> euler_bases(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
