// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing of two coupled wheels with parallel axes: pitch circles, and the belt over them. The page of `report` draws
// the same (templates/report/shapes.js). External gears rotate in opposite directions and touch between the centres. A
// gear in a ring gear, both on a carrier, touches outside the centres. Pulleys take the radii of disks drawn on the two
// bodies, otherwise a size at which the belt is visible.
#pragma once

#include <array>
#include <vector>

#include "analysis/drawing/sketch.hpp"

namespace eomgen::analysis {

struct WheelPair {
  std::array<Point, 2> centres, axes;
  double ratio = 1;                          // first angular velocity over the second, about these axes
  bool carried = false;                      // both rotate on a third body
  std::array<std::vector<double>, 2> radii;  // of the disks drawn on them
};

/// Draws nothing if the axes are not parallel or no such wheels exist.
void draw(Sketch& sketch, const WheelPair& pair);

}  // namespace eomgen::analysis
