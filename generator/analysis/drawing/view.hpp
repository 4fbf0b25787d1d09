// SPDX-License-Identifier: GPL-3.0-or-later
// Direction of view on a system, in orthographic projection so that lengths can be compared. The page of `report` uses
// the same rules (templates/report/camera.js).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace eomgen::analysis {

using Point = Eigen::Vector3d;
using PlanePoint = Eigen::Vector2d;

class View {
 public:
  /// Looks along the normal if all points lie in a plane of two fixed axes, otherwise from the side and slightly from
  /// above. `points`: at least one, finite. `down`: direction that points downwards on paper.
  View(const std::vector<Point>& points, const std::optional<Point>& down);

  PlanePoint operator()(const Point& r) const { return {right_.dot(r), above_.dot(r)}; }
  const Point& toward() const { return toward_; }  // direction towards the viewer
  bool flat() const { return flat_; }

 private:
  bool flat_;
  Point right_, above_, toward_;
};

}  // namespace eomgen::analysis
