// SPDX-License-Identifier: GPL-3.0-or-later
// Solves the friction laws for the friction forces phi. The equations of motion are linear in phi, so every normal
// force is x = x0 + sum_b L_b phi_b and every slip rate is s0 + sum_b K_b phi_b. Per contact and mode:
//   sticking:  s0 + K phi = 0                              (the slip stays zero, (2.47))
//   sliding:   phi = -mu_d |N| w/|w|                       ((2.33), (2.40)); the smooth law: w / sqrt(w^2 + width^2)
//   open:      phi = 0
// On a surface |N| = p sqrt(g) x, where p is the sign of x in this mode; on a curve |N| follows from a quadratic
// equation. `margin` is negative if friction increases the normal force of a sliding surface so much that the law has
// no solution or several (Painleve).
#pragma once

#include "program/linear_solver.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::program {

/// Monitored functions of one contact. All but slip are positive inside the mode.
struct ContactIndicators {
  Ref slip;    // along the first tangent, signed
  Ref above;   // one tangent: mu_s |N| - phi; two: mu_s |N| - |phi|
  Ref below;   // one tangent: mu_s |N| + phi; two: the slip along the second
  Ref hold;    // surface: p x; open contact: the gap; else 1
  Ref margin;  // uniqueness of the law's solution; 1 if it is always unique
};

struct FrictionSolution {
  std::vector<Ref> qddot, lambda, phi;
  std::vector<Ref> existence, uniqueness;  // negative if a law has no solution, or several
  std::vector<ContactIndicators> indicators;
};

/// Solves the friction laws of all contacts.
FrictionSolution solve_friction_laws(const system::EquationSystem& system, const LinearSolver& solve);

}  // namespace eomgen::program
