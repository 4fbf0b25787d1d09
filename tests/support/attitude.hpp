// SPDX-License-Identifier: GPL-3.0-or-later
// One attitude in every representation of rotations, in the syntax of model files.
#pragma once

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <array>
#include <cstdio>
#include <optional>
#include <string>

#include "rotations/rotation.hpp"

namespace eomgen::test {

/// Rows e_k . E_j of an attitude far from the singularities of all sets of Euler angles.
inline Eigen::Matrix3d sample_attitude() {
  return (Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 0.4, -0.7).normalized()).toRotationMatrix() *
          Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.2, 1, 0.3).normalized()).toRotationMatrix())
      .transpose();
}

/// Angles of a set that give this attitude: Gauss-Newton from several starts.
inline std::array<double, 3> angles_of(const std::string& set, const Eigen::Matrix3d& wanted) {
  const auto residual = [&](const Eigen::Vector3d& n) {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    for (int s = 0; s < 3; ++s)
      R = Eigen::AngleAxisd(-n[s], Eigen::Vector3d::Unit(set[static_cast<std::size_t>(s)] - '1')).toRotationMatrix() *
          R;
    return Eigen::Matrix<double, 9, 1>((R - wanted).reshaped());
  };
  for (int start = 0; start < 64; ++start) {
    Eigen::Vector3d n(0.3 + 1.5 * (start % 4), 0.3 + 0.7 * (start / 4 % 4), 0.3 + 1.5 * (start / 16));
    for (int step = 0; step < 60; ++step) {
      Eigen::Matrix<double, 9, 3> slope;
      for (int k = 0; k < 3; ++k)
        slope.col(k) =
            (residual(n + 1e-6 * Eigen::Vector3d::Unit(k)) - residual(n - 1e-6 * Eigen::Vector3d::Unit(k))) / 2e-6;
      n -= (slope.transpose() * slope).inverse() *
           (slope.transpose() * residual(n));  // far from where it has no inverse; a QR takes seconds to compile
    }
    if (residual(n).norm() < 1e-14) return {n[0], n[1], n[2]};
  }
  FAIL("no angles of ", set);
  return {};
}

struct Attitude {
  std::string rotation;  // with the coordinates n0 .. n3
  std::string start;     // their values
};

/// The attitude in a representation; nothing if it cannot represent every attitude.
inline std::optional<Attitude> attitude_in(const rotations::Rotation& r, const Eigen::Matrix3d& wanted) {
  const auto value = [](const char* name, double x) {
    char text[60];
    std::snprintf(text, sizeof text, "%s = %.17g", name, x);
    return std::string(text);
  };
  if (r.family == "euler") {
    const std::array<double, 3> n = angles_of(r.name, wanted);
    return Attitude{"{ euler = \"" + r.name + "\", angles = [\"n1\", \"n2\", \"n3\"] }",
                    value("n1", n[0]) + ", " + value("n2", n[1]) + ", " + value("n3", n[2])};
  }
  const bool four = r.name == "euler_parameters";
  if (!four && r.name != "rodrigues") return std::nullopt;
  const Eigen::Quaterniond q(Eigen::Matrix3d(wanted.transpose()));
  const double by = four ? 1 : q.w();
  return Attitude{
      four ? "{ euler_parameters = [\"n0\", \"n1\", \"n2\", \"n3\"] }" : "{ rodrigues = [\"n1\", \"n2\", \"n3\"] }",
      (four ? value("n0", q.w()) + ", " : "") + value("n1", q.x() / by) + ", " + value("n2", q.y() / by) + ", " +
          value("n3", q.z() / by)};
}

}  // namespace eomgen::test
