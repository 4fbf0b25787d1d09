// SPDX-License-Identifier: GPL-3.0-or-later
// Representations of rotations as data: a family is one file with a function that returns a Rotation, a representation
// is one line in registry.cpp. The formulas are in the model language, in terms of the names of the entries. The model
// reader expands axes and angular velocities with them, so that no later stage depends on a representation.
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

/// A step maps the axes p1 p2 p3 to e_k = sum_j R[k][j] p_j. `w` holds the components along e1 e2 e3 of the relative
/// angular velocity.
struct Step {
  std::array<Components, 3> R;
  Components w;
};

struct Rotation {
  std::string name;    // unique: "313", "euler_parameters"
  std::string family;  // the key in model files: "euler", "axis", ...
  std::string title;
  std::vector<Entry> entries;
  std::vector<Step> steps;
  /// w = sum_i basis_i d(entry_i)/dt, eq. (5.59), and w . dual_i = d(entry_i)/dt: components along the axes after the
  /// last step.
  std::vector<Components> basis, dual;
  std::string unit = {};         // constraint on the entries: this expression is 0; empty: no constraint
  std::string singular = {};     // where the basis has no dual, as text; empty: nowhere
  std::string singularity = {};  // an expression that is 0 exactly there
};

std::span<const Rotation> registry();
const Rotation* find(std::string_view name);  // nullptr if there is none

/// The rotation about axis 0, 1 or 2 by the angle `n`.
Step about_axis(std::size_t axis, const std::string& n);

}  // namespace eomgen::rotations
