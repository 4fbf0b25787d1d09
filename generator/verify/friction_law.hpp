// SPDX-License-Identifier: GPL-3.0-or-later
// Friction forces at a state: of any size, for what the equations make of them; and those that Coulomb's law asks for,
// found by Newton's iteration on the law as it stands, without the closed forms of the program.
#pragma once

#include "verify/system_values.hpp"

namespace eomgen::verify {

/// Sets State::phi and the forces that it stands for, along the tangents of the mechanics.
void set_friction(const mechanics::Mechanics& mechanics, const Judge& judge, State& state, std::vector<Real> phi);

/// phi of the law in the mode of the state. Throws std::domain_error where the iteration finds none.
std::vector<Real> lawful_friction(const system::EquationSystem& system, const Judge& judge, const State& state);

}  // namespace eomgen::verify
