// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion linearised at a state, on the constraint manifold (docs/theory.md, "Linearisation"). In: an
// EquationSystem without contacts and a state. Out: A, B in independent coordinates and speeds, eigenvalues, what kind
// of motion the state is on.
#pragma once

#include "linear/spectrum.hpp"
#include "linear/steady.hpp"

namespace eomgen::linear {

enum class Kind { equilibrium, steady, motion };
const char* name(Kind kind);  // "equilibrium", "steady motion", "motion"

struct Linearisation {
  Kind kind = Kind::motion;
  State<Precise> z;
  Setting<Precise> setting;
  Symmetry symmetry;
  Field<Precise> field;           // at z
  Matrix<Precise> tangent, A, B;  // in y = entries of z
  Spectrum spectrum;
  std::size_t structural_zeros = 0;
  double off = 0;            // Steady::off
  int known = known_digits;  // of A
};

/// `neighbours`: the same with other parameters, by which zeros that are there for all parameters are told from others.
/// Throws std::domain_error where the equations have no slope.
Linearisation linearise(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting,
                        const std::vector<Setting<Precise>>& neighbours, std::uint64_t seed);

}  // namespace eomgen::linear
