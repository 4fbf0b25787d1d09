// SPDX-License-Identifier: GPL-3.0-or-later
// Curvilinear coordinate systems as data: a system is one file with one of these and one line in registry.cpp.
// The expressions are in the language of model files, over the slot names (and the system's own constants); the model
// reader spells a position out with them, so that nothing downstream knows a coordinate system by name.
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

/// A further key of the position ("pitch", "angle"), which the expressions use; no name if there is none.
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
  std::string_view singular;                         // where det(a_ik) = 0, for reading
  bool planar;                                       // two entries allowed, the third is 0
  Constant constant;
};

std::span<const CoordinateSystem* const> registry();
const CoordinateSystem* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::coordinates
