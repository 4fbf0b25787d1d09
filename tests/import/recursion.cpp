// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/recursion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace eomgen::test {
namespace {

using Rotation = std::array<Triple, 3>;

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple sum(const Triple& a, const Triple& b, double factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
Triple times(const Rotation& R, const Triple& v) { return {dot(R[0], v), dot(R[1], v), dot(R[2], v)}; }
Rotation transposed(const Rotation& R) {
  return {{{R[0][0], R[1][0], R[2][0]}, {R[0][1], R[1][1], R[2][1]}, {R[0][2], R[1][2], R[2][2]}}};
}
Rotation product(const Rotation& A, const Rotation& B) {
  const Rotation columns = transposed(B);
  return transposed({times(A, columns[0]), times(A, columns[1]), times(A, columns[2])});
}
/// Rodrigues' formula: cos(a) 1 + sin(a) [n x] + (1 - cos(a)) n n^T.
Rotation about(const Triple& axis, double angle) {
  const double length = std::sqrt(dot(axis, axis)), c = std::cos(angle), s = std::sin(angle);
  const Triple n{axis[0] / length, axis[1] / length, axis[2] / length};
  Rotation R{};
  for (std::size_t k = 0; k < 3; ++k) {
    Triple e{};
    e[k] = 1;
    const Triple turned = sum(sum({c * e[0], c * e[1], c * e[2]}, cross(n, e), s), n, (1 - c) * n[k]);
    for (std::size_t i = 0; i < 3; ++i) R[i][k] = turned[i];
  }
  return R;
}
Rotation by_rpy(const Triple& rpy) {
  return product(about({0, 0, 1}, rpy[2]), product(about({0, 1, 0}, rpy[1]), about({1, 0, 0}, rpy[0])));
}

Rotation tensor_of(const RobotJoint& joint) {
  const auto& J = joint.tensor;
  const Rotation A = by_rpy(joint.inertial_rpy), tensor{{{J[0], J[1], J[2]}, {J[1], J[3], J[4]}, {J[2], J[4], J[5]}}};
  return product(A, product(tensor, transposed(A)));
}

/// A joint in motion: all vectors along the axes of the world.
struct Motion {
  Rotation R{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Triple p{}, w{}, wdot{}, v{}, vdot{}, n{};  // n: the joint's axis
};

/// Generalised forces that a motion needs: outwards kinematics, inwards Newton and Euler about the origin.
std::vector<double> inverse_dynamics(const std::vector<RobotJoint>& robot, const std::vector<double>& q,
                                     const std::vector<double>& qdot, const std::vector<double>& qddot, double g) {
  std::vector<Motion> motions(robot.size());
  std::vector<Triple> force(robot.size()), moment(robot.size());
  for (std::size_t i = 0, k = 0; i < robot.size(); ++i) {
    const RobotJoint& joint = robot[i];
    Motion parent;
    parent.vdot = {0, 0, g};
    if (joint.parent >= 0) parent = motions[static_cast<std::size_t>(joint.parent)];
    Motion& m = motions[i] = parent;
    const Triple d = times(parent.R, joint.xyz);
    m.R = product(parent.R, by_rpy(joint.rpy));
    m.n = times(m.R, joint.axis);
    const double length = std::sqrt(dot(m.n, m.n));
    for (double& entry : m.n) entry /= length;
    Triple arm = d;
    const std::size_t own = k;
    if (joint.moves()) ++k;
    if (joint.type == "prismatic") arm = sum(d, m.n, q[own]);
    m.p = sum(parent.p, arm);
    m.v = sum(parent.v, cross(parent.w, arm));
    m.vdot = sum(sum(parent.vdot, cross(parent.wdot, arm)), cross(parent.w, cross(parent.w, arm)));
    if (joint.type == "prismatic") {
      m.v = sum(m.v, m.n, qdot[own]);
      m.vdot = sum(sum(m.vdot, cross(parent.w, m.n), 2 * qdot[own]), m.n, qddot[own]);
    } else if (joint.moves()) {
      m.R = product(m.R, about(joint.axis, q[own]));
      m.w = sum(parent.w, m.n, qdot[own]);
      m.wdot = sum(sum(parent.wdot, cross(parent.w, m.n), qdot[own]), m.n, qddot[own]);
    }
    const Triple c = times(m.R, joint.centre);
    const Rotation I = product(m.R, product(tensor_of(joint), transposed(m.R)));
    const Triple a = sum(sum(m.vdot, cross(m.wdot, c)), cross(m.w, cross(m.w, c)));
    force[i] = {joint.mass * a[0], joint.mass * a[1], joint.mass * a[2]};
    moment[i] = sum(sum(times(I, m.wdot), cross(m.w, times(I, m.w))), cross(sum(m.p, c), force[i]));
  }
  std::vector<double> result(q.size());
  std::size_t k = q.size();
  for (std::size_t i = robot.size(); i-- > 0;) {
    const Motion& m = motions[i];
    if (robot[i].moves()) {
      --k;
      result[k] =
          robot[i].type == "prismatic" ? dot(m.n, force[i]) : dot(m.n, sum(moment[i], cross(m.p, force[i]), -1));
      result[k] += robot[i].damping * qdot[k];
    }
    if (robot[i].parent < 0) continue;
    const std::size_t parent = static_cast<std::size_t>(robot[i].parent);
    force[parent] = sum(force[parent], force[i]);
    moment[parent] = sum(moment[parent], moment[i]);
  }
  return result;
}

std::string text_of(const Triple& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); }

std::string link_text(const std::string& name, const RobotJoint& link) {
  if (link.mass == 0) return fmt::format("  <link name=\"{}\"/>\n", name);
  const auto& J = link.tensor;
  return fmt::format(
      "  <link name=\"{}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"{}\"/>\n      <mass value=\"{}\"/>\n"
      "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n  "
      "</link>\n",
      name, text_of(link.centre), text_of(link.inertial_rpy), link.mass, J[0], J[1], J[2], J[3], J[4], J[5]);
}

/// The body of a link and, inside of it, those of links that hang on it.
std::string mjcf_body(const std::vector<RobotJoint>& robot, int index, const RobotJoint& link,
                      const std::string& joint) {
  std::string text =
      fmt::format("<body name=\"{}\" pos=\"{}\" euler=\"{}\">\n{}", index < 0 ? "base" : fmt::format("l{}", index),
                  text_of(link.xyz), text_of(link.rpy), joint);
  if (link.mass != 0) {
    const Rotation J = tensor_of(link);
    text += fmt::format("<inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{} {} {} {} {} {}\"/>\n", text_of(link.centre),
                        link.mass, J[0][0], J[1][1], J[2][2], J[0][1], J[0][2], J[1][2]);
  }
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const RobotJoint& child = robot[i];
    if (child.parent != index) continue;
    std::string own;
    if (child.moves())
      own = fmt::format("<joint name=\"j{}\" type=\"{}\" axis=\"{}\" damping=\"{}\"/>\n", i,
                        child.type == "prismatic" ? "slide" : "hinge", text_of(child.axis), child.damping);
    text += mjcf_body(robot, static_cast<int>(i), child, own);
  }
  return text + "</body>\n";
}

}  // namespace

std::string mjcf_of(const std::vector<RobotJoint>& robot, const RobotJoint& base, bool free) {
  return "<mujoco model=\"test\">\n<compiler angle=\"radian\" eulerseq=\"XYZ\"/>\n<worldbody>\n" +
         mjcf_body(robot, -1, base, free ? "<freejoint name=\"base\"/>\n" : "") + "</worldbody>\n</mujoco>\n";
}

std::vector<std::vector<double>> equations_of(const std::vector<RobotJoint>& robot, const std::vector<double>& q,
                                              const std::vector<double>& qdot, double g) {
  const std::size_t n = q.size();
  const std::vector<double> zero(n, 0.0), h = inverse_dynamics(robot, q, qdot, zero, g);
  std::vector<std::vector<double>> rows(n, std::vector<double>(n + 1));
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> unit = zero;
    unit[k] = 1;
    const std::vector<double> column = inverse_dynamics(robot, q, zero, unit, 0);
    for (std::size_t i = 0; i < n; ++i) rows[i][k] = column[i];
    rows[k][n] = -h[k];
  }
  return rows;
}

std::vector<double> solve(std::vector<std::vector<double>> rows) {
  const std::size_t n = rows.size();
  for (std::size_t k = 0; k < n; ++k) {  // positive definite: no pivoting
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j <= n; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  std::vector<double> x(n);
  for (std::size_t k = n; k-- > 0;) {
    x[k] = rows[k][n];
    for (std::size_t j = k + 1; j < n; ++j) x[k] -= rows[k][j] * x[j];
    x[k] /= rows[k][k];
  }
  return x;
}

std::vector<double> accelerations(const std::vector<RobotJoint>& robot, const std::vector<double>& q,
                                  const std::vector<double>& qdot, double g) {
  return solve(equations_of(robot, q, qdot, g));
}

std::string urdf_of(const std::vector<RobotJoint>& robot, const RobotJoint& base) {
  std::string text = "<robot name=\"test\">\n" + link_text("base", base);
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const RobotJoint& joint = robot[i];
    text += link_text(fmt::format("l{}", i), joint);
    text += fmt::format(
        "  <joint name=\"j{0}\" type=\"{1}\">\n    <origin xyz=\"{2}\" rpy=\"{3}\"/>\n    <parent link=\"{4}\"/>\n"
        "    <child link=\"l{0}\"/>\n    <axis xyz=\"{5}\"/>\n    <dynamics damping=\"{6}\"/>\n  </joint>\n",
        i, joint.type, text_of(joint.xyz), text_of(joint.rpy),
        joint.parent < 0 ? "base" : fmt::format("l{}", joint.parent), text_of(joint.axis), joint.damping);
  }
  return text + "</robot>\n";
}

}  // namespace eomgen::test
