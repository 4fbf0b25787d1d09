// SPDX-License-Identifier: GPL-3.0-or-later
// Two wheels that turn together about parallel axes, on paper: pitch circles, and the belt over them. The page of
// `report` draws the same (templates/report/shapes.js). Gears that mesh outside turn against one another and touch
// between the centres; a gear in a ring, both on a carrier, beyond them. Pulleys of a belt have any size: that of a
// pair of disks drawn on the two bodies, else one that leaves the belt to be seen.
#pragma once

#include <array>
#include <vector>

#include "analysis/drawing/sketch.hpp"

namespace eomgen::analysis {

struct WheelPair {
  std::array<Point, 2> centres, axes;
  double ratio = 1;                          // of the first speed to the second, about these axes
  bool carried = false;                      // both turn on a third body
  std::array<std::vector<double>, 2> radii;  // of what is drawn on them
};

/// Nothing where the axes are not parallel, or no such wheels exist.
void draw(Sketch& sketch, const WheelPair& pair);

}  // namespace eomgen::analysis
