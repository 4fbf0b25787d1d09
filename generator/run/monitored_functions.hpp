// SPDX-License-Identifier: GPL-3.0-or-later
// Functions that a run monitors in addition to the compiled ones: functions that may jump, forces that are narrow in
// the state. In: a system. Out: expressions as data for eom/hybrid.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <optional>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

/// Energies, constraints, positions and velocities if the equations have kinks; otherwise empty.
eom::hybrid::JumpFunctions jump_functions(const system::EquationSystem& system);

/// Whether velocities may jump at a time that the model states, as by a prescribed position 0.3*abs(t - 1).
bool may_jump_in_time(const system::EquationSystem& system);

/// `none`: functions that vanish, for any error control, a few widths away: exp, tanh, sinh, cosh, high powers of the
/// state. `any`: also those with tails: quotients whose divisor is a sum, such as 1/sqrt(1 + (x/w)^2)^3, and atan.
enum class Tails { none, any };

/// Functions that may be narrow in the state.
std::vector<eom::expressions::Table> narrow_functions(const system::EquationSystem& system, Tails tails = Tails::any);

/// Tables of event functions that depend on the state, by index among the event functions; empty if they have no
/// bounds.
std::vector<eom::expressions::Table> bounded_events(const system::EquationSystem& system,
                                                    const std::vector<std::optional<symbolic::Ref>>& functions);

}  // namespace eomgen::run
