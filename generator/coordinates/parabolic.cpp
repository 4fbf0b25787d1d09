// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {

// v = 0 is the upper half of the axis, u = 0 the lower half. u and v are square roots of lengths.
CoordinateSystem parabolic() {
  return {
      .name = "parabolic",
      .title = "parabolic coordinates u, v, theta (about E3): r = u v, z = (u^2 - v^2)/2",
      .slots = {{{"u", "m^(1/2)", "0", ""}, {"v", "m^(1/2)", "0", ""}, {"theta", "rad", "", ""}}},
      .x = {"u*v*cos(theta)", "u*v*sin(theta)", "(u^2 - v^2)/2"},
      .e = {{{"v*cos(theta)/sqrt(u^2 + v^2)", "v*sin(theta)/sqrt(u^2 + v^2)", "u/sqrt(u^2 + v^2)"},
             {"u*cos(theta)/sqrt(u^2 + v^2)", "u*sin(theta)/sqrt(u^2 + v^2)", "-v/sqrt(u^2 + v^2)"},
             {"-sin(theta)", "cos(theta)", "0"}}},
      .singular = "u = 0, v = 0",
      .planar = false,
      .constant = {},
  };
}

}  // namespace eomgen::coordinates
