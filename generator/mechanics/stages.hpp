// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of build_mechanics, in the order in which they run.
#pragma once

#include "mechanics/lowering.hpp"

namespace eomgen::mechanics {

void add_masses(Mechanics& mechanics, Lowering& lower);       // masses, kinetic energy, eq. (1.31), (3.20)
void add_bodies(Mechanics& mechanics, Lowering& lower);       // rotations, eq. (6.65)
void add_forces(Mechanics& mechanics, Lowering& lower);       // potential, loads, generalised forces
void add_constraints(Mechanics& mechanics, Lowering& lower);  // psi and its gradient, eq. (2.31)
void add_contacts(Mechanics& mechanics, Lowering& lower);  // Coulomb friction: tangents and slip, eqs. (2.33), (2.40)
void check_friction_coefficients(const Mechanics& mechanics);  // of friction, where they depend on parameters alone
void eliminate_coordinates(Mechanics& mechanics);              // by constraints q_c = d(t), eq. (2.96)
// contact_forces.hpp
bool needs_contact_inputs(const Mechanics& mechanics);
void require_contact_inputs(Mechanics& mechanics);  // of constraints, so that they are not eliminated
void number_contact_inputs(Mechanics& mechanics);
void list_active_constraints(Mechanics& mechanics);      // those that keep a multiplier
void add_joints(Mechanics& mechanics, Lowering& lower);  // their reactions
bool holds_identically(Dag& dag, Ref psi);               // proven or numerical; false if unknown
void drop_repeated_equations(Mechanics& mechanics);      // that [[constraint]]s imply identically; or throws
void drop_dependent_equations(Mechanics& mechanics, Lowering& lower);  // implied where all hold, as in loops
/// Whether an equation may be redundant because a user cannot omit it: equations of joints, unit lengths, rolling and
/// vectors.
bool may_be_redundant(const Mechanics& mechanics, const Constraint& constraint);
const model::Constraint& model_constraint(const Mechanics& mechanics, const Constraint& constraint);
void drop_blocked_directions(Mechanics& mechanics);  // along which other constraints block sliding
/// Finds directions that other contacts block while closed, or always. Contacts whose slip the constraints prescribe
/// get the width 0. Throws Error if no direction is left for friction and nothing slips. False if contacts with one
/// that can open could hold more directions than are free.
bool find_blocked_directions(Mechanics& mechanics);
const model::Friction& friction_law_of(const Mechanics& mechanics, const Contact& contact);

}  // namespace eomgen::mechanics
