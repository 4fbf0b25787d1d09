// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {

CoordinateSystem cartesian() {
  return {
      .name = "cartesian",
      .title = "Cartesian coordinates x, y, z",
      .slots = {{{"x", "m", "", ""}, {"y", "m", "", ""}, {"z", "m", "", ""}}},
      .x = {"x", "y", "z"},
      .e = {{{"1", "0", "0"}, {"0", "1", "0"}, {"0", "0", "1"}}},
      .singular = "",
      .planar = true,
      .constant = {},
  };
}

}  // namespace eomgen::coordinates
