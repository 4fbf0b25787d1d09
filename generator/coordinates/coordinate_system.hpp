// SPDX-License-Identifier: GPL-3.0-or-later
// Curvilinear coordinate systems as data: a system is one file with a function that returns a CoordinateSystem, and
// one line in registry.inc. The expressions are in the model language, in terms of the slot names and the system's own
// constant. The model reader expands positions with them, so that no later stage depends on a coordinate system.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace eomgen::coordinates {

struct Slot {
  std::string_view name;   // "phi"
  std::string_view unit;   // "m", "rad", "1", "m^(1/2)"
  std::string_view lower;  // open range of the chart as expressions; empty: unbounded
  std::string_view upper;
};

/// An additional key of the position ("pitch", "angle") that the expressions use; an empty name if there is none.
struct Constant {
  std::string_view name;
  std::string_view unit;
};

struct CoordinateSystem {
  std::string_view name;  // the key in model files
  std::string_view title;
  std::array<Slot, 3> slots;
  std::array<std::string_view, 3> x;                 // Cartesian components, eq. (1.16)
  std::array<std::array<std::string_view, 3>, 3> e;  // unit vectors along a_i; empty strings: normalise a_i
  std::string_view singular;                         // where det(a_ik) = 0, as text
  bool planar;                                       // two entries suffice, the third is then 0
  Constant constant;
};

std::span<const CoordinateSystem> registry();
const CoordinateSystem* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::coordinates
