// SPDX-License-Identifier: GPL-3.0-or-later
// The motion by the oracle alone: accelerations and multipliers for which d'Alembert's residuals and psi_ddot vanish.
#pragma once

#include "oracle/dalembert.hpp"

namespace eomgen::verify {

struct Motion {
  State state;               // with qddot
  std::vector<Real> lambda;  // per scalar constraint
  /// The change of qddot, and of lambda, for errors as large as the terms of the equations; far smaller values are
  /// rounding.
  std::vector<Real> scale, lambda_scale;
};

/// Solves for qddot and lambda. The residuals are affine in them: N + 1 evaluations and one solve. Throws Singular if
/// qddot and lambda are not determined.
Motion solve_motion(const Oracle& oracle, const State& state);

/// Smallest scale of an acceleration, or multiplier, of a system with constraints, relative to the largest one: smaller
/// values may be zero up to rounding.
Real minimum_relative_scale(const model::Model& model);

}  // namespace eomgen::verify
