// SPDX-License-Identifier: GPL-3.0-or-later
// What a run looks at beside the compiled functions: what may jump, forces that are narrow in the state. In: a system.
// Out: expressions as data for eom/hybrid.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <optional>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

/// Energies, constraints, places and velocities, where the equations have kinks; else empty.
eom::hybrid::JumpFunctions jump_functions(const system::EquationSystem& system);

/// Bumps without tails: exp, tanh, sinh, cosh, powers of the state.
std::vector<eom::expressions::Table> narrow_functions(const system::EquationSystem& system);

/// Of functions of the state, by their place among the event functions; empty ones where there are no bounds.
std::vector<eom::expressions::Table> bounded_events(const system::EquationSystem& system,
                                                    const std::vector<std::optional<symbolic::Ref>>& functions);

}  // namespace eomgen::run
