// SPDX-License-Identifier: GPL-3.0-or-later
// Solids with their positions. In: parts of a drawing, their sizes, values of its vectors. Out: solids of bodies and of
// particles with a shape in [draw]; the axes of a particle are the fixed ones.
#pragma once

#include <functional>
#include <vector>

#include "analysis/drawing/solids.hpp"

namespace eomgen::analysis {

struct PlacedSolids {
  std::size_t place;
  std::vector<Solid> solids;
  std::function<Point(const Point&)> world;  // transformation from body axes to space
};

std::vector<PlacedSolids> placed_solids(const DrawnParts& parts, const std::vector<double>& sizes,
                                        const std::vector<double>& values);

}  // namespace eomgen::analysis
