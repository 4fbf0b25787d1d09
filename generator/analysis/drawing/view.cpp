// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/view.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace eomgen::analysis {
namespace {

constexpr double in_plane = 1e-9;  // relative to the extent of all points
constexpr double azimuth = 0.6, elevation = 0.3;

}  // namespace

View::View(const std::vector<Point>& points, const std::optional<Point>& down) {
  Point low = points.front(), high = points.front();
  for (const Point& r : points) {
    low = low.cwiseMin(r);
    high = high.cwiseMax(r);
  }
  const Point extent = high - low;
  std::optional<int> normal;
  for (int k = 2; k >= 0 && !normal; --k) {
    if (extent[k] <= in_plane * extent.norm()) normal = k;
  }
  if (normal && down && std::abs((*down)[*normal]) > 0.99 * down->norm()) normal.reset();
  flat_ = normal.has_value();
  const Point up = down ? Point(-down->normalized()) : Point::Unit(normal == 2 ? 1 : 2);
  if (flat_) {
    toward_ = Point::Unit(*normal);
    // Axes should point to the right rather than to the left.
    if (up.cross(toward_).sum() < 0) toward_ = -toward_;
    above_ = up;
  } else {
    Point other = Point::Unit(0);
    for (int k = 1; std::abs(other.dot(up)) >= 0.5; ++k) other = Point::Unit(k);
    const Point front = (other - other.dot(up) * up).normalized(), side = up.cross(front);
    const Point level = std::cos(azimuth) * front + std::sin(azimuth) * side;
    toward_ = std::cos(elevation) * level + std::sin(elevation) * up;
    above_ = std::cos(elevation) * up - std::sin(elevation) * level;
  }
  right_ = above_.cross(toward_);
}

}  // namespace eomgen::analysis
