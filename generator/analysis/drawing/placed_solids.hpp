// SPDX-License-Identifier: GPL-3.0-or-later
// Solids with their positions. In: the drawn solids of places, their sizes, values of vectors. Out: numbers.
#pragma once

#include <functional>
#include <vector>

#include "analysis/drawing/primitives.hpp"

namespace eomgen::analysis {

struct PlacedSolids {
  std::size_t place;
  std::vector<Solid> solids;
  std::function<Point(const Point&)> world;  // transformation from body axes to space
};

/// Axes of drawn solids as columns.
Eigen::Matrix3d axes_of(const DrawnSolids& drawn, const std::vector<double>& values);

/// One entry for each of `primitives.solids`.
std::vector<PlacedSolids> placed_solids(const DrawnParts& parts, const Primitives& primitives,
                                        const std::vector<double>& values);

}  // namespace eomgen::analysis
