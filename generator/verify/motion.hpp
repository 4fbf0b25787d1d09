// SPDX-License-Identifier: GPL-3.0-or-later
// The motion by the judge alone: accelerations and multipliers for which d'Alembert's residuals and psi_ddot vanish.
#pragma once

#include "verify/dalembert.hpp"

namespace eomgen::verify {

struct Motion {
  State state;               // with qddot
  std::vector<Real> lambda;  // per scalar constraint
  /// What errors of the size of the equations' terms do to qddot: what is far smaller is rounding.
  std::vector<Real> scale;
};

/// The residuals are affine in qddot and lambda: N + 1 evaluations and one solve. Throws Singular where qddot and
/// lambda are not determined.
Motion motion_at(const Judge& judge, const State& state);

/// What is smaller than this beside the largest acceleration, or multiplier, of a system with constraints counts as if
/// it were as large: it may be what rounding leaves of 0.
Real least_share(const model::Model& model);

}  // namespace eomgen::verify
