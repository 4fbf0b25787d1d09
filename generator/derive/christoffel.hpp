// SPDX-License-Identifier: GPL-3.0-or-later
// The christoffel route: M_ik(q) qddot_i + [ij,k] qdot_i qdot_j = Q_k with the symbols of the first kind (2.184),
// (2.177), and with the terms of T1 and T0 and of dM/dt where something moves by prescription.
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Small systems: few coordinates, a kinetic energy that is quadratic in the velocities and expands within the budget.
std::optional<system::EquationSystem> christoffel(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
