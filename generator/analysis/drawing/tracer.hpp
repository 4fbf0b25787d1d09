// SPDX-License-Identifier: GPL-3.0-or-later
// Curve tracing by continuation. In: n - 1 equations in n coordinates, and the position as a function of them. Out:
// points in space at equal distances along the solution curve.
#pragma once

#include <utility>

#include "analysis/drawing/surface_lines.hpp"

namespace eomgen::analysis {

/// Values (n - 1) and Jacobian (n - 1 x n) of the equations; nullopt if they are undefined.
using CurveEquations =
    std::function<std::optional<std::pair<Eigen::VectorXd, Eigen::MatrixXd>>(const Eigen::VectorXd&)>;

class CurveTracer {
 public:
  CurveTracer(const SurfaceFunction& function, const SurfaceSetting& place)
      : f_(function), place_(place), n_(place.q.size()) {}

  /// Change of coordinate k that moves the position by about the size of the figure.
  double span(Eigen::Index k) const;
  /// Step length in space.
  double step() const;
  bool is_inside(const Eigen::VectorXd& q, const Eigen::VectorXd& low, const Eigen::VectorXd& high) const;
  /// Projects q onto the curve by Newton's method with minimum-norm steps, scaled by span(). Returns nullopt if it does
  /// not converge in `tries` iterations.
  std::optional<Eigen::VectorXd> project_onto(const CurveEquations& equations, Eigen::VectorXd q, int tries) const;
  /// Traces the curve in both directions from a point until it closes (then the first and last points are equal) or
  /// leaves the box.
  std::vector<Point> trace(const CurveEquations& equations, const Eigen::VectorXd& start, const Eigen::VectorXd& low,
                           const Eigen::VectorXd& high) const;

 private:
  /// Tangent of the curve, per unit of distance in space.
  std::optional<Eigen::VectorXd> tangent(const CurveEquations& equations, const Eigen::VectorXd& q) const;

  const SurfaceFunction& f_;
  const SurfaceSetting& place_;
  Eigen::Index n_;
};

}  // namespace eomgen::analysis
