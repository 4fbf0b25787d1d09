// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {

// The basis is not orthogonal; the coordinate curves of theta are helices.
CoordinateSystem helical() {
  return {
      .name = "helical",
      .title = "helical coordinates theta, r, nu = z - pitch r theta",
      .slots = {{{"theta", "rad", "", ""}, {"r", "m", "0", ""}, {"nu", "m", "", ""}}},
      .x = {"r*cos(theta)", "r*sin(theta)", "nu + pitch*r*theta"},
      .e = {{{"-sin(theta)/sqrt(1 + pitch^2)", "cos(theta)/sqrt(1 + pitch^2)", "pitch/sqrt(1 + pitch^2)"},
             {"cos(theta)/sqrt(1 + pitch^2*theta^2)", "sin(theta)/sqrt(1 + pitch^2*theta^2)",
              "pitch*theta/sqrt(1 + pitch^2*theta^2)"},
             {"0", "0", "1"}}},
      .singular = "r = 0",
      .planar = false,
      .constant = {"pitch", "1"},
  };
}

}  // namespace eomgen::coordinates
