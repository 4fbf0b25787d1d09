// SPDX-License-Identifier: GPL-3.0-or-later
// A kinetic energy that is a sum of squares of velocities of points is that of particles: sum m/2 (x_dot^2 + y_dot^2 +
// z_dot^2), however it is written. In: Mechanics with an energy and no masses. Out: particles with the same energy, in
// whatever space.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::derive {

/// Nothing where the energy is anything else, or where few coordinates make it not worth looking. Coordinates x, y, z
/// are those squares that move with the same coordinates and have the same mass; which is which, and their signs, are
/// such that a coordinate moves as many particles as can be by the same vector. They have no name and no place.
std::optional<std::vector<mechanics::PointMass>> particles_of_energy(mechanics::Mechanics& mechanics);

}  // namespace eomgen::derive
