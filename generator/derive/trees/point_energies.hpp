// SPDX-License-Identifier: GPL-3.0-or-later
// A kinetic energy that is a sum of squares of velocities of points is that of particles: sum m/2 (x_dot^2 + y_dot^2 +
// z_dot^2), however it is written. In: Mechanics with an energy and no masses. Out: particles with the same energy, in
// an abstract space.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::derive {

/// Empty for any other energy, or if there are too few coordinates for a gain. Squares that move with the same
/// coordinates and have the same mass become x, y, z of one particle. Their order and signs are chosen such that a
/// coordinate moves as many particles as possible by the same vector. The particles have no name and no place.
std::optional<std::vector<mechanics::PointMass>> particles_of_energy(mechanics::Mechanics& mechanics);

}  // namespace eomgen::derive
