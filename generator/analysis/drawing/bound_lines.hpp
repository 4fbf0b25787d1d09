// SPDX-License-Identifier: GPL-3.0-or-later
// A curve or a surface psi(q) = 0 as a figure shows it. In: psi and the position x as functions of two or three
// coordinates q, where the particle is, how large the figure is. Out: lines in space: the curve; the edge of a plane;
// of other surfaces a net around the particle and the outline, where the surface is seen from its side.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/drawing/view.hpp"

namespace eomgen::analysis {

struct BoundPoint {
  Eigen::VectorXd psi;
  Eigen::MatrixXd slope;  // dpsi/dq: one row for each psi
  Point x;
  Eigen::Matrix3Xd turn;  // dx/dq
};
/// Nothing where there is no value.
using BoundFunction = std::function<std::optional<BoundPoint>(const Eigen::VectorXd& q)>;

struct BoundPlace {
  Eigen::VectorXd q;
  Eigen::VectorXd low, high;  // bounds of the coordinates, infinite where there is none
  std::vector<bool> angle;
  double size;  // of the figure, in the unit of x
};

struct BoundLine {
  std::vector<Point> points;
  bool edge;  // of a plane, an outline, a curve; else of a net
};

/// One coordinate more than psi has entries, or two.
std::vector<BoundLine> bound_lines(const BoundFunction& function, const BoundPlace& place, const View& view);

}  // namespace eomgen::analysis
