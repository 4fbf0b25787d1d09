// SPDX-License-Identifier: GPL-3.0-or-later
// Routh's reduction: cyclic coordinates drop out of the equations, and their momenta remain as constants. In:
// Mechanics, the cyclic coordinates. Out: the Routhian and the equations of the other coordinates, by the constrained
// Lagrangian. Theory: docs/theory.md, "Routh's reduction"; (2.172), (2.173).
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

struct RouthForm {
  bool is_unexpanded = false;  // too large to expand, or the momenta do not determine the rates; the rest is empty
  std::vector<std::uint32_t> cyclic;
  std::vector<PowerOfSum> powers;   // of the potential, as in DisplayForm
  std::vector<Sum> momenta;         // dL/dqdot_c, per cyclic coordinate
  std::vector<Sum> rates;           // qdot_c as functions of the momenta
  Sum routhian;                     // L - sum p_c qdot_c
  std::optional<Sum> energy;        // sum qdot_a dR/dqdot_a - R, if R is free of t
  std::vector<Equation> equations;  // of the free coordinates that are not cyclic
};

/// The symbol of the conserved momentum dL/dqdot of this coordinate.
Symbol momentum_symbol(std::uint32_t coordinate);

RouthForm routh_form(const mechanics::Mechanics& mechanics, const std::vector<std::uint32_t>& cyclic);

/// Residuals that vanish for the true motion: the reduced equations with the momenta substituted, and the rates of the
/// momenta.
std::vector<symbolic::Ref> residuals_on_dag(const RouthForm& form, mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
