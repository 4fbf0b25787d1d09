// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/placed_solids.hpp"

#include <Eigen/Geometry>

#include "lists.hpp"

namespace eomgen::analysis {

Eigen::Matrix3d axes_of(const DrawnSolids& drawn, const std::vector<double>& values) {
  if (!drawn.axes) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes;
  for (int k = 0; k < 2; ++k) axes.col(k) = Point(values.data() + (*drawn.axes)[static_cast<std::size_t>(k)]);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

std::vector<PlacedSolids> placed_solids(const DrawnParts& parts, const Primitives& primitives,
                                        const std::vector<double>& values) {
  return mapped(primitives.solids, [&](const DrawnSolids& drawn) {
    const Point centre(values.data() + parts.places[drawn.place].at);
    PlacedSolids placed{drawn.place, {}, [centre, axes = axes_of(drawn, values)](const Point& r) -> Point {
                          return centre + axes * r;
                        }};
    for (const DrawnSolid& solid : drawn.list) {
      if (auto found = evaluate(solid, primitives.size_values)) placed.solids.push_back(std::move(*found));
    }
    return placed;
  });
}

}  // namespace eomgen::analysis
