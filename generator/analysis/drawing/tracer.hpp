// SPDX-License-Identifier: GPL-3.0-or-later
// Along curves of coordinates. In: equations, as many as there are coordinates but one, and the positions. Out: points
// in space, at equal distances.
#pragma once

#include <utility>

#include "analysis/drawing/bound_lines.hpp"

namespace eomgen::analysis {

/// Values and slopes; nothing where there are none.
using Equations = std::function<std::optional<std::pair<Eigen::VectorXd, Eigen::MatrixXd>>(const Eigen::VectorXd&)>;

class Tracer {
 public:
  Tracer(const BoundFunction& function, const BoundPlace& place) : f_(function), place_(place), n_(place.q.size()) {}

  /// By how much a coordinate changes where the position changes by the size of the figure.
  double span(Eigen::Index k) const;
  /// In space.
  double step() const;
  bool is_inside(const Eigen::VectorXd& q, const Eigen::VectorXd& low, const Eigen::VectorXd& high) const;
  /// Newton's method by the smallest steps, relative to the spans.
  std::optional<Eigen::VectorXd> onto(const Equations& equations, Eigen::VectorXd q, int tries) const;
  /// Both ways from a point, until the curve closes (its first point is its last then) or leaves the box.
  std::vector<Point> trace(const Equations& equations, const Eigen::VectorXd& start, const Eigen::VectorXd& low,
                           const Eigen::VectorXd& high) const;

 private:
  /// The direction in which nothing changes, by the distance in space.
  std::optional<Eigen::VectorXd> along(const Equations& equations, const Eigen::VectorXd& q) const;

  const BoundFunction& f_;
  const BoundPlace& place_;
  Eigen::Index n_;
};

}  // namespace eomgen::analysis
