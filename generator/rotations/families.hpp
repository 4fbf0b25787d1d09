// SPDX-License-Identifier: GPL-3.0-or-later
// The families of rotations, one file each.
#pragma once

#include "rotations/rotation.hpp"

namespace eomgen::rotations {

/// Euler angles n1, n2, n3 about the axes i, j, k (1 to 3), each of the already rotated triad, eqs. (5.57)-(5.59).
Rotation euler(int i, int j, int k);
/// One angle about a fixed axis with unit vector r1, r2, r3 (components along the parent's axes), eq. (5.32).
Rotation fixed_axis();
/// Euler parameters e0 = cos(p/2), (e1, e2, e3) = sin(p/2) r, eq. (5.53).
Rotation euler_parameters();
/// Rodrigues parameters tan(p/2) r, eq. (5.47).
Rotation rodrigues();
Rotation fixed();

}  // namespace eomgen::rotations
