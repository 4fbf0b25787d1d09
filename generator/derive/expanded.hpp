// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// The lagrange equations of energies that are expanded first, sin^2 + cos^2 = 1 used; best for small systems. Applies
/// where the kinetic energy fits into the term budget of the expansion.
std::optional<system::EquationSystem> expanded(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
