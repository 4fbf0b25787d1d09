// SPDX-License-Identifier: GPL-3.0-or-later
// What every fast route ends with: Lagrange's equations in the form M qddot = f + A^T lambda in all coordinates are
// split into those of the motion and those of the constraint forces ((2.98)), and everything is written out.
#pragma once

#include "derive/imposition.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// M qddot = f + sum_k lambda_k grad psi_k, all N coordinates; M: N x N row-major, f: N. Symbols of the eliminated
/// coordinates may still be there.
struct FullEquations {
  std::vector<Ref> M, f;
};

/// Rows of the free coordinates, constraints, reactions, outputs. `motion` gives M (n x n) and f (n) of the free
/// coordinates where a route has derived them from the constrained energies (Approach II); otherwise they are the rows
/// of `full` with the constraints imposed (Approach I).
system::EquationSystem assemble(Mechanics& mechanics, const FullEquations& full, const FullEquations* motion,
                                const char* route, system::Approach approach);

/// Q_i = sum F . dr/dq_i + given generalised forces, eq. (3.20), for all coordinates.
std::vector<Ref> generalized_forces(Mechanics& mechanics);

/// What the energy's rate must be, with the reactions of `system`: docs/theory.md, "Power". May use qddot.
Ref power(Mechanics& mechanics, const system::EquationSystem& system);

/// 0, 1, ... of all coordinates of the model.
std::vector<std::uint32_t> all_coordinates(const Mechanics& mechanics);

}  // namespace eomgen::derive
