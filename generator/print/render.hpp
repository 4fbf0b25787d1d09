// SPDX-License-Identifier: GPL-3.0-or-later
// What `derive`, `check` and documents show. In: Mechanics and ReadingForm. Out: printed items.
#pragma once

#include <string>
#include <vector>

#include "print/printer.hpp"
#include "reading/linear_form.hpp"
#include "reading/reading.hpp"
#include "reading/routh.hpp"

namespace eomgen::print {

/// One printed formula. `key`: equations (momentum form, one per coordinate), explicit (M qddot + h = Q), reactions,
/// friction, basis, metric, christoffel, line_element, frenet, energies, lagrangian, constraints, singular.
struct Item {
  std::string key, name;
  std::string coordinate;
  std::string text, latex, mathml;
  std::string role;
  std::string left_out = {};  // why nothing is shown; empty where it is
};

/// The items that `show` names (keys, or "all"); "equations" brings the explicit form along. Where it is interrupted,
/// it throws work::Interrupted, or tells so in `interrupted` and gives the items that are there.
std::vector<Item> render(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                         const std::vector<std::string>& show, bool* interrupted = nullptr);

/// M, C, K, B under the key "linear": along a motion, and at rest with the equations of an equilibrium.
std::vector<Item> render_linear(const mechanics::Mechanics& mechanics, const reading::LinearForm& form);

/// Routh's reduction under the key "routh": constant momenta, the rates that they give, the Routhian, the reduced
/// equations.
std::vector<Item> render_routh(const mechanics::Mechanics& mechanics, const reading::RouthForm& form);

/// The singular sets alone, of which `form` knows nothing.
std::vector<Item> render_singular(const mechanics::Mechanics& mechanics);

/// Any expression of the Dag, simplified for reading: potentials, conserved quantities.
Item render_expression(const mechanics::Mechanics& mechanics, std::string key, std::string name,
                       symbolic::Ref expression);

Item render_expression(const mechanics::Mechanics& mechanics, std::string key, std::string name,
                       const reading::Sum& expression);

}  // namespace eomgen::print
