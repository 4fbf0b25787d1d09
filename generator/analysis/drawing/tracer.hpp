// SPDX-License-Identifier: GPL-3.0-or-later
// Curve tracing by continuation. In: n - 1 equations in n coordinates, and the position as a function of them. Out:
// points in space at equal distances along the solution curve.
#pragma once

#include <utility>

#include "analysis/drawing/bound_lines.hpp"

namespace eomgen::analysis {

/// Values (n - 1) and Jacobian (n - 1 x n) of the equations; nullopt if they are undefined.
using Equations = std::function<std::optional<std::pair<Eigen::VectorXd, Eigen::MatrixXd>>(const Eigen::VectorXd&)>;

class Tracer {
 public:
  Tracer(const BoundFunction& function, const BoundPlace& place) : f_(function), place_(place), n_(place.q.size()) {}

  /// Change of coordinate k that moves the position by about the size of the figure.
  double span(Eigen::Index k) const;
  /// Step length in space.
  double step() const;
  bool is_inside(const Eigen::VectorXd& q, const Eigen::VectorXd& low, const Eigen::VectorXd& high) const;
  /// Projects q onto the curve by Newton's method with minimum-norm steps, scaled by span(). Returns nullopt if it does
  /// not converge in `tries` iterations.
  std::optional<Eigen::VectorXd> onto(const Equations& equations, Eigen::VectorXd q, int tries) const;
  /// Traces the curve in both directions from a point until it closes (then the first and last points are equal) or
  /// leaves the box.
  std::vector<Point> trace(const Equations& equations, const Eigen::VectorXd& start, const Eigen::VectorXd& low,
                           const Eigen::VectorXd& high) const;

 private:
  /// Tangent of the curve, per unit of distance in space.
  std::optional<Eigen::VectorXd> along(const Equations& equations, const Eigen::VectorXd& q) const;

  const BoundFunction& f_;
  const BoundPlace& place_;
  Eigen::Index n_;
};

}  // namespace eomgen::analysis
