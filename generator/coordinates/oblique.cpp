// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {

// q1 = x1 sec(angle), q2 = x2 - x1 tan(angle), q3 = x3: the coordinate lines are straight and oblique.
CoordinateSystem oblique() {
  return {
      .name = "oblique",
      .title = "oblique coordinates q1, q2, q3; the line of q1 makes `angle` with E1",
      .slots = {{{"q1", "m", "", ""}, {"q2", "m", "", ""}, {"q3", "m", "", ""}}},
      .x = {"q1*cos(angle)", "q2 + q1*sin(angle)", "q3"},
      .e = {{{"cos(angle)", "sin(angle)", "0"}, {"0", "1", "0"}, {"0", "0", "1"}}},
      .singular = "cos(angle) = 0",
      .planar = true,
      .constant = {"angle", "rad"},
  };
}

}  // namespace eomgen::coordinates
