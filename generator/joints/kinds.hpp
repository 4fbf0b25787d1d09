// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of joints, and the equations from which they are composed.
#pragma once

#include "joints/joint.hpp"

namespace eomgen::joints {

#define JOINT(name) Joint name();
#include "joints/registry.inc"
#undef JOINT

std::vector<Equation> same_point();     // r_B = r_A, eq. (7.16)
std::vector<Equation> point_on_axis();  // r_B is on the axis through r_A
std::vector<Equation> same_axis();      // the axes are parallel: the two equations that a pin adds, eq. (7.18)
Equation no_rotation_about_axis();

/// Concatenates groups of equations.
std::vector<Equation> concatenate(std::vector<std::vector<Equation>> groups);

}  // namespace eomgen::joints
