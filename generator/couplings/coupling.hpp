// SPDX-License-Identifier: GPL-3.0-or-later
// Couplings of two rotations as data: a kind of [[constraint]] that is one file with a function that makes one of
// these, and one line in registry.inc. The formulas are in the language of model files; the model reader spells them
// out as a constraint on velocities, so that nothing downstream knows a coupling by name.
//
// Names in the formulas: ratio; wA, wB the angular velocities of the bodies against the carrier, a and b the unit
// vectors of their axes; or angle1 and angle2.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace eomgen::couplings {

struct Coupling {
  std::string name;  // KIND = { .. } of a [[constraint]]: unique
  std::string title;
  std::string of_bodies, of_angles;  // what is 0; the multiplier is the moment on the first
};

std::span<const Coupling> registry();
const Coupling* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::couplings
