// SPDX-License-Identifier: GPL-3.0-or-later
// Conserved quantities that follow from the form of the equations: momenta of cyclic coordinates, the energy, and the
// Jacobi integral where the energy itself is not conserved (docs/theory.md, "Conserved quantities").
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

struct Conserved {
  std::string name;   // "energy", "momentum.theta", "jacobi"; also the name of the output
  std::string title;  // for reading
  symbolic::Ref expression;  // in the symbols of the EquationSystem
};

/// Output that is d psi/d q, or d psi/d t for "t", of an integral: for projections, not for tables.
std::string differential_output(const mechanics::Integral& integral, const std::string& variable);
inline constexpr const char* differential_prefix = "differential.";

/// Appends an output for each quantity that is not an output already (momenta, Jacobi integral, integrals of constraints).
std::vector<Conserved> conserved_quantities(mechanics::Mechanics& mechanics, system::EquationSystem& system);

}  // namespace eomgen::derive
