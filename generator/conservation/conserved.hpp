// SPDX-License-Identifier: GPL-3.0-or-later
// Conserved quantities that follow from the form of the equations: momenta of cyclic coordinates, the energy, and the
// Jacobi integral where the energy itself is not conserved (docs/theory.md, "Conserved quantities").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::conservation {

/// How far it is certain that an expression vanishes for all values of its symbols.
enum class Certainty { no, numerical, proven };
const char* name(Certainty certainty);  // "no", "numerical", "proven"

/// `proven`: multiplied out, nothing is left; `numerical`: zero in 40 digits at random points.
Certainty vanishing(symbolic::Dag& dag, const std::vector<symbolic::Ref>& expressions);

struct Conserved {
  std::string name;          // "energy", "momentum.theta", "jacobi", "linear_momentum.E1"; also the name of the output
  std::string title;         // for reading
  symbolic::Ref expression;  // in the symbols of the EquationSystem
  system::OutputKind kind = system::OutputKind::energy;  // of that output
  std::uint32_t index = 0, part = 0;                     // as it has them
  Certainty certainty = Certainty::numerical;
  std::optional<symbolic::Ref> magnitude = {};  // size of the terms that it is the sum of, for the drift of a run
};

/// Appends an output for each quantity that is not an output already (momenta, Jacobi integral, integrals of
/// constraints), and what runs need: the differentials of these integrals, and magnitudes.
std::vector<Conserved> conserved_quantities(mechanics::Mechanics& mechanics, system::EquationSystem& system);

/// The same of systems of one Mechanics, which all have the same energies and constraints: found once, offered by all.
std::vector<Conserved> conserved_quantities(mechanics::Mechanics& mechanics,
                                            std::vector<system::EquationSystem>& systems);

std::vector<std::uint32_t> cyclic_coordinates(const std::vector<Conserved>& conserved);

}  // namespace eomgen::conservation
