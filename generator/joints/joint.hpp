// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of joints as data: a kind is one file with a function that returns a Joint, and one line in registry.inc. The
// formulas are in the model language. The model reader expands them for two bodies, so that no later stage depends on a
// kind of joint.
//
// Names in the formulas, all of them vectors: d from the point of A to the point of B; a, a1, a2 a right-handed triad
// fixed in A, with a along the axis; b along the axis and fixed in B; b2 fixed in B and along a2 at the start; f1 f2 f3
// the axes of A (or E1 E2 E3); g1 g2 g3 fixed in B and along f1 f2 f3 at the start.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::joints {

/// An equation psi = 0, and the reaction on B for lambda = 1: a force at its point and a moment; "" means zero.
struct Equation {
  std::string psi, force, moment;
};

/// The axes of a joint: none; one line fixed in both bodies; one line in each body, which intersect.
enum class AxisLayout { none, shared, crossed };

struct Joint {
  std::string name;  // unique; the value of `type` in a model file: "pin"
  std::string title;
  AxisLayout axes = AxisLayout::none;
  std::vector<Equation> equations;
};

std::span<const Joint> registry();
const Joint* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::joints
