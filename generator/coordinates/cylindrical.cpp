// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {

CoordinateSystem cylindrical() {
  return {
      .name = "cylindrical",
      .title = "cylindrical polar coordinates r, theta, z",
      .slots = {{{"r", "m", "0", ""}, {"theta", "rad", "", ""}, {"z", "m", "", ""}}},
      .x = {"r*cos(theta)", "r*sin(theta)", "z"},
      .e = {{{"cos(theta)", "sin(theta)", "0"}, {"-sin(theta)", "cos(theta)", "0"}, {"0", "0", "1"}}},
      .singular = "r = 0",
      .planar = true,
      .constant = {},
  };
}

}  // namespace eomgen::coordinates
