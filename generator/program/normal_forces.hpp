// SPDX-License-Identifier: GPL-3.0-or-later
// Normal forces on curves that are coupled by friction. The multipliers of curve c are lambda = a + sum_d b_d nu_d with
// the normal forces nu, and nu_c = |lambda^T G lambda|^(1/2). These are C coupled quadratic equations for C unknowns.
#pragma once

#include <array>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::program {

struct CurveForce {
  std::vector<symbolic::Ref> gram;              // G, 2 x 2
  std::array<symbolic::Ref, 2> a;               // multipliers for zero friction on the curves
  std::vector<std::array<symbolic::Ref, 2>> b;  // per curve: derivative of the multipliers by its normal force
};

struct NormalForces {
  std::vector<symbolic::Ref> nu;
  symbolic::Ref solution_margin;  // negative: no solution, several, or no convergence
  symbolic::Ref multiplicity;     // positive if there are several solutions in that case
};

/// Solves for one curve in closed form. Solves for several curves by an unrolled Newton iteration that starts at the
/// frictionless normal forces. Steps that would make a normal force negative are halved. If friction changes no normal
/// force by more than its own value, the solution is unique and the iteration converges.
NormalForces coupled_normal_forces(symbolic::Dag& dag, const std::vector<CurveForce>& curves);

}  // namespace eomgen::program
