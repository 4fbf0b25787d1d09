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
  Certainty certainty = Certainty::numerical;
  std::optional<std::uint32_t> cyclic = {};     // the coordinate whose generalised momentum it is
  std::optional<symbolic::Ref> magnitude = {};  // size of the terms that it is the sum of, for the drift of a run
};

/// Output that is d psi/d q, or d psi/d t for "t", of an integral: for projections, not for tables.
std::string differential_output(const mechanics::Integral& integral, const std::string& variable);
inline constexpr const char* differential_prefix = "differential.";

inline constexpr const char* magnitude_prefix = "magnitude.";
std::string magnitude_output(const Conserved& conserved);  // for runs, not for tables

/// Appends an output for each quantity that is not an output already (momenta, Jacobi integral, integrals of
/// constraints), and for magnitudes.
std::vector<Conserved> conserved_quantities(mechanics::Mechanics& mechanics, system::EquationSystem& system);

/// The same of systems of one Mechanics, which all have the same energies and constraints: found once, offered by all.
std::vector<Conserved> conserved_quantities(mechanics::Mechanics& mechanics,
                                            std::vector<system::EquationSystem>& systems);

std::vector<std::uint32_t> cyclic_coordinates(const std::vector<Conserved>& conserved);

}  // namespace eomgen::conservation
