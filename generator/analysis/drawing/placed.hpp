// SPDX-License-Identifier: GPL-3.0-or-later
// Solids where they are. In: parts of a drawing, their sizes, values of its vectors. Out: the solids of bodies, and of
// particles that [draw] gives a shape, whose axes are the fixed ones.
#pragma once

#include <functional>
#include <vector>

#include "analysis/drawing/solids.hpp"

namespace eomgen::analysis {

struct Placed {
  std::size_t place;
  std::vector<Solid> solids;
  std::function<Point(const Point&)> world;  // from its own axes
};

std::vector<Placed> placed_solids(const DrawnParts& parts, const std::vector<double>& sizes,
                                  const std::vector<double>& values);

}  // namespace eomgen::analysis
