// SPDX-License-Identifier: GPL-3.0-or-later
// Lines that show a constraint curve or surface psi(q) = 0. In: psi and the position x as functions of two or three
// coordinates q, the particle's position, the size of the figure. Out: lines in space. A curve gives itself and a plane
// its border. Other surfaces give a net around the particle and the silhouette.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/drawing/view.hpp"

namespace eomgen::analysis {

struct SurfacePoint {
  Eigen::VectorXd psi;
  Eigen::MatrixXd slope;  // dpsi/dq: one row per entry of psi, one column per coordinate
  Point x;
  Eigen::Matrix3Xd turn;  // dx/dq: 3 x n
};
/// Returns nullopt where psi or x is undefined.
using SurfaceFunction = std::function<std::optional<SurfacePoint>(const Eigen::VectorXd& q)>;

struct SurfaceSetting {
  Eigen::VectorXd q;
  Eigen::VectorXd low, high;  // bounds of the coordinates; infinite: no bound
  std::vector<bool> angle;    // whether each coordinate is an angle
  double size;                // of the figure, in the unit of x
};

struct SurfaceLine {
  std::vector<Point> points;
  bool edge;  // a border, a silhouette or a curve; false: a line of the net
};

/// Requires one or two coordinates more than psi has entries.
std::vector<SurfaceLine> surface_lines(const SurfaceFunction& function, const SurfaceSetting& place, const View& view);

}  // namespace eomgen::analysis
