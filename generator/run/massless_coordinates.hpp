// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints that coordinates without inertia satisfy, such as those that follow the nearest point of a rim. In:
// equations. Out: the constraints whose jumps change nothing else. An impulse of such a constraint would change the
// momentum of its coordinate, which is always 0.
#pragma once

#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

struct MasslessJumps {
  std::vector<bool> position;  // per constraint: psi may jump, as it has a coordinate without inertia of its own
  std::vector<bool> velocity;  // per constraint: its row and rate may jump
};

/// Whether the kinetic energy does not depend on the rate of a free coordinate. coordinate: index into system.free.
bool is_massless(const system::EquationSystem& system, std::size_t coordinate);

MasslessJumps massless_jumps(const system::EquationSystem& system);

}  // namespace eomgen::run
