// SPDX-License-Identifier: GPL-3.0-or-later
// Newton-Euler recursion in doubles on a table of joints, which shares nothing with the generator.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace eomgen::test {

using Triple = std::array<double, 3>;

/// A joint and the link that it carries, as URDF states them: all with respect to the joint's own axes.
struct RobotJoint {
  std::string type;  // revolute, continuous, prismatic, fixed
  int parent = -1;   // index of a joint before this one; -1: the base
  Triple xyz{}, rpy{}, axis{0, 0, 1};
  double mass = 0;
  Triple centre{}, inertial_rpy{};
  std::array<double, 6> tensor{};  // xx, xy, xz, yy, yz, zz
  double damping = 0;

  bool moves() const { return type != "fixed"; }
};

/// Accelerations of the coordinates (of the joints that move, in their order) under gravity along -z.
std::vector<double> accelerations(const std::vector<RobotJoint>& robot, const std::vector<double>& q,
                                  const std::vector<double>& qdot, double g);
/// M qddot = -h: the mass matrix by rows, and -h behind each.
std::vector<std::vector<double>> equations_of(const std::vector<RobotJoint>& robot, const std::vector<double>& q,
                                              const std::vector<double>& qdot, double g);
std::vector<double> solve(std::vector<std::vector<double>> equations);

/// The same robot as a URDF file: joints j0, j1, .., links base, l0, l1, ...
std::string urdf_of(const std::vector<RobotJoint>& robot, const RobotJoint& base);
/// The same as an MJCF file. `free`: the base has a free joint.
std::string mjcf_of(const std::vector<RobotJoint>& robot, const RobotJoint& base, bool free = false);

}  // namespace eomgen::test
