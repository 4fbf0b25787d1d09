// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Equations from velocity Jacobians: M = sum m J^T J, f = Q - dU/dq - sum J^T (m Jdot qdot + mdot v). Applies where
/// there are masses at known positions and nothing but them (no [energy] kinetic).
std::optional<system::EquationSystem> jacobian(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
