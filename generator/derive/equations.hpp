// SPDX-License-Identifier: GPL-3.0-or-later
// The last step of every formulation. Lagrange's equations M qddot = f + A^T lambda in all coordinates are split into
// the equations of motion and those of the constraint forces ((2.98)). Functions of time are expanded.
#pragma once

#include "derive/imposition.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// M qddot = f + sum_k lambda_k grad psi_k in all N coordinates; M: N x N row-major, f: N. Symbols of the eliminated
/// coordinates may still occur.
struct FullEquations {
  std::vector<Ref> M, f;
};

/// Adds constraints, reactions and outputs to the rows of the free coordinates. `motion` gives M (n x n) and f (n) of
/// the free coordinates if a formulation derived them from the constrained energies (Approach II). Otherwise they are
/// the rows of `full` with the constraints imposed (Approach I).
system::EquationSystem assemble(Mechanics& mechanics, const FullEquations& full, const FullEquations* motion,
                                const char* formulation, system::Approach approach);

/// Q_i = sum F . dr/dq_i + given generalised forces, eq. (3.20), for all coordinates.
std::vector<Ref> generalized_forces(Mechanics& mechanics);

/// The rate of the energy according to the power balance, with the reactions of `system`: docs/theory.md, "Power". May
/// contain qddot.
Ref power(Mechanics& mechanics, const system::EquationSystem& system);

/// 0, 1, ... of all coordinates of the model.
std::vector<std::uint32_t> all_coordinates(const Mechanics& mechanics);

}  // namespace eomgen::derive
