// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Whether the energies fit into the term budget of the expansion.
bool expanded_applies(mechanics::Mechanics& mechanics, system::Approach approach);

/// The lagrange equations of energies that are expanded first, sin^2 + cos^2 = 1 used; best for small systems.
system::EquationSystem expanded(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
