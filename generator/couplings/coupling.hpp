// SPDX-License-Identifier: GPL-3.0-or-later
// Couplings of two rotations as data: a kind of [[constraint]] is one file with a function that returns a Coupling, and
// one line in registry.inc. The formulas are in the model language. The model reader expands them into a constraint on
// velocities, so that no later stage depends on a kind of coupling.
//
// Names in the formulas: ratio; for bodies wA and wB, the angular velocities relative to the carrier, with the unit
// vectors a and b of their axes; for angles angle1 and angle2.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace eomgen::couplings {

struct Coupling {
  std::string name;  // unique; the key of a [[constraint]]: KIND = { .. }
  std::string title;
  std::string body_equation,
      angle_equation;  // left-hand sides of "= 0"; the multiplier is the moment on the first body
};

std::span<const Coupling> registry();
const Coupling* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::couplings
