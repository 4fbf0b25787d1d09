// SPDX-License-Identifier: GPL-3.0-or-later
// From where a system is looked at, without perspective, so that lengths can be compared. The page of `report` finds
// its view by the same rules (templates/report/camera.js).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace eomgen::analysis {

using Point = Eigen::Vector3d;
using PlanePoint = Eigen::Vector2d;

class View {
 public:
  /// Along the normal where all points are in a plane of two fixed axes, else from the side and a little from above;
  /// things fall downwards. `points`: at least one, finite.
  View(const std::vector<Point>& points, const std::optional<Point>& down);

  PlanePoint operator()(const Point& r) const { return {right_.dot(r), above_.dot(r)}; }
  const Point& toward() const { return toward_; }  // the reader
  bool flat() const { return flat_; }

 private:
  bool flat_;
  Point right_, above_, toward_;
};

}  // namespace eomgen::analysis
