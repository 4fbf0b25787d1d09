// SPDX-License-Identifier: GPL-3.0-or-later
// Approach II where an integrable constraint gives a coordinate in terms of the others: u = psi takes its place among
// the coordinates and is 0, eqs. (9.69), (9.86).
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// The same system with every coordinate eliminated that a constraint without friction gives as a function of the
/// others: psi linear in it, with a factor that is no function of the motion and not 0. It shares the Dag.
Mechanics impose_dependent(const Mechanics& mechanics);

}  // namespace eomgen::mechanics
