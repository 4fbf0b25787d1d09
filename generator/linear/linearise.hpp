// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion linearised at a state, on the constraint manifold (docs/theory.md, "Linearisation"). In: an EquationSystem
// without contacts and a state. Out: A, B in independent coordinates and speeds, eigenvalues, what kind of motion the state is on.
#pragma once

#include "linear/chart.hpp"
#include "linear/spectrum.hpp"

namespace eomgen::linear {

enum class Kind { equilibrium, steady, motion };
const char* name(Kind kind);  // "equilibrium", "steady motion", "motion"

struct Linearisation {
  Kind kind = Kind::motion;
  State<Precise> z;
  Setting<Precise> setting;
  Symmetry symmetry;
  Field<Precise> field;          // at z
  Matrix<Precise> tangent, A, B;  // in y = entries of z
  Spectrum spectrum;
  std::size_t structural_zeros = 0;
};

/// The steady motion next to z: entries of z that it keeps have no rates, positions that nothing feels stay as they are; `extra`
/// adds equations (values, slopes by z). Nothing where Newton's iteration finds none.
using Extra = std::function<void(const State<Precise>& z, Matrix<Precise>& value, Matrix<Precise>& slope)>;
std::optional<State<Precise>> steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                           const Setting<Precise>& setting, const Extra& extra = {});

/// `neighbours`: the same with other parameters, by which zeros that are there for all parameters are told from others. Throws
/// std::domain_error where the equations have no slope.
Linearisation linearise(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting,
                        const std::vector<Setting<Precise>>& neighbours, std::uint64_t seed);

}  // namespace eomgen::linear
