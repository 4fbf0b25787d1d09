// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Whether there are masses at known positions and nothing but them (no [energy] kinetic).
bool jacobian_applies(mechanics::Mechanics& mechanics, system::Approach approach);

/// Equations from velocity Jacobians: M = sum m J^T J, f = Q - dU/dq - sum J^T (m Jdot qdot + mdot v).
system::EquationSystem jacobian(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
