// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of joints as data: a kind is one file with a function that makes one of these, and one line in registry.cpp.
// The formulas are in the language of model files; the model reader spells them out for two bodies, so that nothing
// downstream knows a joint by name.
//
// Names in the formulas, vectors all: d from the point of A to that of B; a, a1, a2 a right-handed triad fixed in A, a
// along the axis; b along the axis, fixed in B; b2 fixed in B, along a2 at the start; f1 f2 f3 the axes of A (or E1 E2
// E3), g1 g2 g3 fixed in B and along them at the start.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::joints {

/// psi = 0, and what lambda = 1 is on B: a force at its point and a moment; "" where there is none.
struct Equation {
  std::string psi, force, moment;
};

enum class Axes { none, line, cross };  // none; one line in both; a line in each, which cross

struct Joint {
  std::string name;  // type = "pin": unique
  std::string title;
  Axes axes = Axes::none;
  std::vector<Equation> equations;
};

std::span<const Joint> registry();
const Joint* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::joints
