// SPDX-License-Identifier: GPL-3.0-or-later
// Conserved quantities that follow from the form of the equations: momenta of cyclic coordinates, the energy, and the
// Jacobi integral if the energy itself is not conserved (docs/theory.md, "Conserved quantities").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::conservation {

using mechanics::Mechanics;
using symbolic::Dag;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// The certainty that an expression vanishes for all values of its symbols.
enum class Certainty { no, numerical, proven };
const char* name(Certainty certainty);  // "no", "numerical", "proven"

/// `proven`: the expanded expression is empty; `numerical`: zero in 40 digits at random points.
Certainty zero_certainty(symbolic::Dag& dag, const std::vector<symbolic::Ref>& expressions);

struct ConservedQuantity {
  std::string name;          // "energy", "momentum.theta", "jacobi", "linear_momentum.E1"; also the name of the output
  std::string title;         // for display
  symbolic::Ref expression;  // in the symbols of the EquationSystem
  system::OutputKind kind = system::OutputKind::energy;  // of that output
  std::uint32_t index = 0, part = 0;                     // of that output
  Certainty certainty = Certainty::numerical;
  std::optional<symbolic::Ref> magnitude = {};  // size of the summed terms, for the drift of a run
  /// Parameters that must be 0 for it (conserved_where_zero); usually none.
  std::vector<std::uint32_t> zero_parameters = {};
};

/// Appends an output for each quantity that is not an output already (momenta, Jacobi integral, integrals of
/// constraints). Also appends what runs need: the differentials of these integrals, and magnitudes.
std::vector<ConservedQuantity> conserved_quantities(mechanics::Mechanics& mechanics, system::EquationSystem& system);

/// The same for several systems of one Mechanics, which share energies and constraints: found once, appended to all.
std::vector<ConservedQuantity> conserved_quantities(mechanics::Mechanics& mechanics,
                                                    std::vector<system::EquationSystem>& systems);

std::vector<std::uint32_t> cyclic_coordinates(const std::vector<ConservedQuantity>& conserved);

}  // namespace eomgen::conservation
