// SPDX-License-Identifier: GPL-3.0-or-later
// The laws of friction closed: what the friction forces phi are. The equations of motion are linear in phi, so that
// every normal force is x = x0 + sum_b L_b phi_b and every rate of slip s0 + sum_b K_b phi_b. Then, per contact and
// mode,
//   sticking:  s0 + K phi = 0                              (the slip stays zero, (2.47))
//   sliding:   phi = -mu_d |N| w/|w|                       ((2.33), (2.40)); the smooth law: w / sqrt(w^2 + width^2)
//   apart:     phi = 0
// with |N| = p sqrt(g) x on a surface (p: the sign of x, which the mode holds), a quadratic equation on a curve. Where
// a sliding surface presses so hard on itself that the law has no solution or several (Painleve), `margin` is negative.
#pragma once

#include "program/solve.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::program {

/// What is watched of one contact; all but slip are positive inside the mode.
struct ContactWatch {
  Ref slip;    // along the first tangent, signed
  Ref above;   // mu_s |N| - phi of one tangent, mu_s |N| - |phi| of two
  Ref below;   // mu_s |N| + phi of one tangent, the slip along the second of two
  Ref hold;    // p x of a surface, the gap of a contact that is apart, 1 elsewhere
  Ref margin;  // of the law's solution, 1 where it always has just one
};

struct FrictionSolution {
  std::vector<Ref> qddot, lambda, phi;
  std::vector<Ref> none, many;  // negative where a law has no solution, or several
  std::vector<ContactWatch> watch;
};

/// Closes the laws of all contacts.
FrictionSolution close_friction(const system::EquationSystem& system, const LinearSolve& solve);

}  // namespace eomgen::program
