// SPDX-License-Identifier: GPL-3.0-or-later
// The statements of a derivation as formulas, independent of the output format.
#pragma once

#include <string>
#include <vector>

#include "reading/reading.hpp"
#include "reading/solved_form.hpp"
#include "results.hpp"

namespace eomgen::print {

using mechanics::Mechanics;
using reading::arrange;
using reading::DisplayForm;
using reading::Equation;
using reading::Formula;
using reading::FormulaKind;
using reading::Layout;
using reading::mark;
using reading::Sum;
using symbolic::Ref;
using symbolic::SymbolKind;

struct Statement {
  std::string key, name, coordinate, role;
  reading::Formula formula;
  std::string left_out = {};  // reason if the formula exceeds its budget
};

/// A placeholder for a formula that exceeds its budget.
inline Statement left_out(std::string key, std::string name, std::string role, std::string why) {
  return {std::move(key), std::move(name), "", std::move(role), reading::mark("..."), std::move(why)};
}

/// q_i, its rate or its acceleration, by `order`.
reading::Formula coordinate(std::uint32_t i, std::uint8_t order);
/// A letter with time-derivative dots.
reading::Formula dotted(reading::Formula letter, int order = 1);
/// A number, as an index.
reading::Formula index(std::uint32_t i);
/// The partial derivative d of/d by.
reading::Formula partial(reading::Formula of, reading::Formula by);
/// The scalar product a . b.
reading::Formula dot_product(reading::Formula a, reading::Formula b);

std::vector<eomgen::Formula> render(const mechanics::Mechanics& mechanics, const std::vector<Statement>& statements);

/// Adds the statements that `show` selects, in a fixed order of keys. If an interruption is thrown, the statements so
/// far are complete.
void add_statements(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                    const std::vector<std::string>& show, std::vector<Statement>& out);

/// d/dt(dL/dqdot) - dL/dq = Q + lambda grad psi, eq. (2.109). `joined`: fractions with factors in one.
reading::Formula momentum_form(const reading::Equation& equation, const std::vector<reading::PowerOfSum>& powers,
                               bool joined = false);
/// M qddot + h = Q + lambda grad psi.
reading::Formula explicit_form(const reading::Equation& equation, const std::vector<reading::PowerOfSum>& powers,
                               bool joined = false);

void add_energies(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form, std::vector<Statement>& out);
/// Components of the angular velocities along the axes of the inertia tensors.
void add_angular_velocities(const reading::DisplayForm& form, std::vector<Statement>& out);
void add_constraints(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                     std::vector<Statement>& out);
void add_equations(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                   std::vector<Statement>& out);
/// The rates of the declared states of first order, as the model states them.
void add_states(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// The values that events and samples set, as the model states them: new values in terms of those before.
void add_resets(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// The letter of a mass: its parameter if that is a single letter, else m with the index of its place.
reading::Formula mass_letter(const mechanics::Mechanics& mechanics, const mechanics::PointMass& mass);
/// Equations that are too long to write out, in terms of named parts. The definitions of the parts have the key
/// "parts".
void add_equations_by_parts(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                            std::vector<Statement>& out);
void add_lagrangian(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                    std::vector<Statement>& out);
void add_reactions(const reading::DisplayForm& form, std::vector<Statement>& out);
/// Constraint force and constraint moment on every body that has coordinates and angles of its own.
void add_constraint_forces(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                           std::vector<Statement>& out);
/// The same with the multipliers as functions of the state, under the key "solved".
void add_constraint_forces(const mechanics::Mechanics& mechanics, const reading::SolvedForm& solved,
                           std::vector<Statement>& out);
/// The linear combination x e_1 + y e_2 + z e_3.
reading::Formula combination(const reading::Components& components, const std::vector<reading::Formula>& vectors);
/// Kinematics of every particle, body, point, frame and definition.
void add_kinematics(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// The regressor of inertial parameters, and the base parameters.
void add_regressor(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// Forces and moments of potentials on bodies.
void add_body_forces(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// Euler and dual Euler bases of bodies and frames, under the key "basis".
void add_euler_bases(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// The equations in contravariant form.
void add_contravariant(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// The bases of E^3N of a system of particles, under the key "basis".
void add_system_basis(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
/// The balance laws of one body in components of its angular velocity.
void add_balance(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);
void add_geometry(const mechanics::Mechanics& mechanics, const std::vector<std::string>& keys,
                  std::vector<Statement>& out);

/// Frenet triad, curvature, torsion and line element of the remaining curve. With `asked`, throws Error if no curve
/// remains.
void add_frenet(const mechanics::Mechanics& mechanics, bool asked, std::vector<Statement>& out);

/// Contacts with friction and unilateral contacts: directions, slip, normal force, the law in every mode.
void add_contacts(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);

void add_singular(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);

}  // namespace eomgen::print
