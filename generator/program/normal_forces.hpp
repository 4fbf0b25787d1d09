// SPDX-License-Identifier: GPL-3.0-or-later
// Normal forces on curves that feel the friction of one another. With lambda = a + sum_d b_d nu_d the multipliers of
// curve c as the normal forces nu change friction, nu_c = |lambda^T G lambda|^(1/2): C equations for C unknowns,
// coupled and quadratic.
#pragma once

#include <array>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::program {

struct CurveForce {
  std::vector<symbolic::Ref> gram;              // G, 2 x 2
  std::array<symbolic::Ref, 2> a;               // multipliers without friction on the curves
  std::vector<std::array<symbolic::Ref, 2>> b;  // per curve: their change with its normal force
};

struct NormalForces {
  std::vector<symbolic::Ref> nu;
  symbolic::Ref settled;  // negative where the law has no solution, or several, or the iteration has not come to rest
  symbolic::Ref several;  // positive where there are several then
};

/// One curve in closed form; several by Newton's iteration, unrolled, from the normal forces without friction: its
/// steps are halved where they would make a normal force negative. Where friction changes no normal force by more than
/// itself there is just one solution, and it converges.
NormalForces coupled_normal_forces(symbolic::Dag& dag, const std::vector<CurveForce>& curves);

}  // namespace eomgen::program
