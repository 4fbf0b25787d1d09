// SPDX-License-Identifier: GPL-3.0-or-later
// The statements of a derivation as formulas, before they are printed in any format.
#pragma once

#include <string>
#include <vector>

#include "reading/reading.hpp"

namespace eomgen::print {

struct Statement {
  std::string key, name, coordinate, role;
  reading::Formula formula;
  std::string left_out = {};  // why there is no formula: it takes more than its budget
};

/// In place of a formula that takes more than its budget.
inline Statement left_out(std::string key, std::string name, std::string role, std::string why) {
  return {std::move(key), std::move(name), "", std::move(role), reading::mark("..."), std::move(why)};
}

/// q_i, its rate or its acceleration.
reading::Formula coordinate(std::uint32_t i, std::uint8_t order);
/// A letter with dots over it.
reading::Formula dotted(reading::Formula letter, int order = 1);
/// A number below a letter.
reading::Formula index(std::uint32_t i);
/// d of/d by
reading::Formula partial(reading::Formula of, reading::Formula by);
/// a . b
reading::Formula dot_product(reading::Formula a, reading::Formula b);

struct Item;  // render.hpp
std::vector<Item> render(const mechanics::Mechanics& mechanics, const std::vector<Statement>& statements);

/// The statements that `show` names, in a fixed order of keys; what is there already when an interruption is thrown is
/// whole.
void add_statements(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                    const std::vector<std::string>& show, std::vector<Statement>& out);

/// d/dt(dL/dqdot) - dL/dq = Q + lambda grad psi, as (2.109).
reading::Formula momentum_form(const reading::Equation& equation);
/// M qddot + h = Q + lambda grad psi.
reading::Formula explicit_form(const reading::Equation& equation);

void add_energies(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form, std::vector<Statement>& out);
/// Components of the angular velocities, along the axes in which the inertias stand.
void add_angular_velocities(const reading::ReadingForm& form, std::vector<Statement>& out);
void add_constraints(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                     std::vector<Statement>& out);
void add_equations(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                   std::vector<Statement>& out);
/// Of a mass of one letter that letter, else m with the number of its place.
reading::Formula mass_letter(const mechanics::Mechanics& mechanics, const mechanics::PointMass& mass);
/// Those that are too long to be written out, by named parts; and these, with the key "parts".
void add_equations_by_parts(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                            std::vector<Statement>& out);
void add_lagrangian(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                    std::vector<Statement>& out);
void add_reactions(const reading::ReadingForm& form, std::vector<Statement>& out);
/// Force and moment of the constraints on every body that has coordinates and angles of its own.
void add_constraint_forces(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                           std::vector<Statement>& out);
/// x e_1 + y e_2 + z e_3
reading::Formula combination(const reading::Components& components, const std::vector<reading::Formula>& vectors);
void add_geometry(const mechanics::Mechanics& mechanics, const std::vector<std::string>& keys,
                  std::vector<Statement>& out);

/// Frenet triad, curvature, torsion, line element of the curve that is left; `asked`: throws Error where there is none.
void add_frenet(const mechanics::Mechanics& mechanics, bool asked, std::vector<Statement>& out);

/// Contacts with friction or that can be left: directions, slip, normal force, the law in every mode.
void add_contacts(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);

void add_singular(const mechanics::Mechanics& mechanics, std::vector<Statement>& out);

}  // namespace eomgen::print
