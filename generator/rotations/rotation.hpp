// SPDX-License-Identifier: GPL-3.0-or-later
// Representations of rotations as data: a family is one file with a function that makes one of these, a representation
// is one line in registry.cpp. The formulas are in the language of model files, over the names of the entries; the
// model reader spells axes and angular velocities out with them, so that nothing downstream knows a representation by
// name.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::rotations {

using Components = std::array<std::string, 3>;

struct Entry {
  std::string name;  // "n1"; its rate is "n1_dot"
  std::string unit;  // "rad", "1"
};

/// A step takes the axes p1 p2 p3 to e_k = sum_j R[k][j] p_j. `w` are the components along e1 e2 e3 of the angular
/// velocity that it adds.
struct Step {
  std::array<Components, 3> R;
  Components w;
};

struct Rotation {
  std::string name;    // "313", "euler_parameters": unique
  std::string family;  // the key in model files: "euler", "axis", ...
  std::string title;
  std::vector<Entry> entries;
  std::vector<Step> steps;
  /// w = sum_i basis_i d(entry_i)/dt, eq. (5.59), and w . dual_i = d(entry_i)/dt: components along the axes after the
  /// last step.
  std::vector<Components> basis, dual;
  std::string unit = {};      // is 0 on the entries that are allowed; empty: all are
  std::string singular = {};  // where the basis has no dual, for reading; empty: nowhere
  std::string regular = {};   // an expression that is 0 just there
};

std::span<const Rotation> registry();
const Rotation* find(std::string_view name);  // nullptr if there is none

/// The rotation about one of the axes (0, 1, 2) by the angle `n`.
Step about_axis(std::size_t axis, const std::string& n);

}  // namespace eomgen::rotations
