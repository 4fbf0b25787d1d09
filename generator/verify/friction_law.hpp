// SPDX-License-Identifier: GPL-3.0-or-later
// Friction forces at a state: arbitrary ones, to test the equations with them; and those of Coulomb's law, by Newton's
// iteration on the law itself, without the closed forms of the program.
#pragma once

#include "verify/system_values.hpp"

namespace eomgen::verify {

/// Sets State::phi and the corresponding forces along the tangents of the mechanics.
void set_friction(const mechanics::Mechanics& mechanics, const Oracle& oracle, State& state, std::vector<Real> phi);

/// phi of the law in the mode of the state. Throws std::domain_error if the iteration does not converge.
std::vector<Real> solve_friction_law(const system::EquationSystem& system, const Oracle& oracle, const State& state);

}  // namespace eomgen::verify
