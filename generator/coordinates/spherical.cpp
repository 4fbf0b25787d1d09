// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {

CoordinateSystem spherical() {
  return {
      .name = "spherical",
      .title = "spherical polar coordinates R, phi (from E3), theta (about E3)",
      .slots = {{{"R", "m", "0", ""}, {"phi", "rad", "0", "pi"}, {"theta", "rad", "", ""}}},
      .x = {"R*sin(phi)*cos(theta)", "R*sin(phi)*sin(theta)", "R*cos(phi)"},
      .e = {{{"sin(phi)*cos(theta)", "sin(phi)*sin(theta)", "cos(phi)"},
             {"cos(phi)*cos(theta)", "cos(phi)*sin(theta)", "-sin(phi)"},
             {"-sin(theta)", "cos(theta)", "0"}}},
      .singular = "R = 0, phi = 0, phi = pi",
      .planar = false,
      .constant = {},
  };
}

}  // namespace eomgen::coordinates
