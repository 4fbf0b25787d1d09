// SPDX-License-Identifier: GPL-3.0-or-later
// Routh's reduction: cyclic coordinates leave the equations, their momenta stay as constants. In: Mechanics, the cyclic
// coordinates. Out: the Routhian and the equations of the other coordinates, by the constrained Lagrangian.
// Theory: docs/theory.md, "Routh's reduction"; (2.172), (2.173).
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

struct RouthForm {
  bool by_parts = false;  // too large to be written out, or the momenta do not give the rates: nothing below
  std::vector<std::uint32_t> cyclic;
  std::vector<Sum> momenta;         // dL/dqdot_c, per cyclic coordinate
  std::vector<Sum> rates;           // qdot_c by the momenta
  Sum routhian;                     // L - sum p_c qdot_c
  std::optional<Sum> energy;        // sum qdot_a dR/dqdot_a - R, where R is free of t
  std::vector<Equation> equations;  // of the free coordinates that are not cyclic
};

/// The constant that dL/dqdot of this coordinate is.
Symbol momentum_symbol(std::uint32_t coordinate);

RouthForm routh_form(const mechanics::Mechanics& mechanics, const std::vector<std::uint32_t>& cyclic);

/// What vanishes for the true motion: the reduced equations with the momenta written out, and the rates of the momenta.
std::vector<symbolic::Ref> residuals_on_dag(const RouthForm& form, mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
