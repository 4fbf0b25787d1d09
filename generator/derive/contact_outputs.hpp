// SPDX-License-Identifier: GPL-3.0-or-later
// In: the contacts of the mechanics, and the equations. Out: their outputs, before constraints are imposed on them.
#pragma once

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Adds friction forces as vectors, slip, the gap of each contact that can open, and the mode of each as a number: 0
/// sticks, 1 and -1 slides, 2 open.
void add_contact_outputs(mechanics::Mechanics& m, system::EquationSystem& s);

}  // namespace eomgen::derive
