// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion linearised at a state, on the constraint manifold (docs/theory.md, "Linearisation"). In: an
// EquationSystem without contacts and a state. Out: A, B in independent coordinates and speeds, eigenvalues, and the
// kind of motion of the state.
#pragma once

#include "linear/spectrum.hpp"
#include "linear/steady.hpp"

namespace eomgen::linear {

enum class MotionKind { equilibrium, steady, motion };
const char* name(MotionKind kind);  // "equilibrium", "steady motion", "motion"

struct Linearisation {
  MotionKind kind = MotionKind::motion;
  State<Precise> z;
  Setting<Precise> setting;
  Symmetry symmetry;
  Field<Precise> field;           // at z
  Matrix<Precise> tangent, A, B;  // in y, entries of z
  Spectrum spectrum;
  std::size_t structural_zeros = 0;
  double parameter_change = 0;  // SteadyState::parameter_change
  int known = known_digits;     // of A
};

/// `neighbours`: the same setting with other parameters. They identify zeros that hold for all parameters. Throws
/// std::domain_error if the equations have no derivative.
Linearisation linearise(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting,
                        const std::vector<Setting<Precise>>& neighbours, std::uint64_t seed);

}  // namespace eomgen::linear
