// SPDX-License-Identifier: GPL-3.0-or-later
// The recursive route: composite masses and forces collected from the tips of the branches to the ground.
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Particles that form a tree (branches.hpp), derived with the constraints imposed; by Approach I only where there is
/// nothing to impose.
std::optional<system::EquationSystem> recursive(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
