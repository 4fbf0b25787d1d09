// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives of the end state of a run by parameters and initial values: the variational equations
//   s' = df/dx s + df/dp dp,   s(t0) = dx0 - f dt0
// are integrated together with x' = f (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section
// I.14), with df/dx and df/dp of the emitted code, under the same error control. At the end, s + f dt1.
#pragma once

#include "run/direction.hpp"
#include "run/runner.hpp"

namespace eomgen::run {

struct Sensitivity {
  std::string of;             // the direction
  std::vector<double> value;  // per state at the end
  std::vector<double> error;  // estimates; empty if not requested
};

struct Sensitivities {
  std::string solver;
  eom::Outcome outcome = eom::Outcome::done;
  double t = 0;
  std::vector<Sensitivity> list;
  eom::Statistics statistics;
  std::string estimate_note;
};

/// Sensitivities of the end of the run with this result. Requires jac and jac_p of `request.code`. Throws
/// Error{stage "run"} for what is not differentiated, and if the end of x differs from that of the run.
Sensitivities integrate_sensitivities(const RunRequest& request, const RunResult& result,
                                      const std::vector<Direction>& directions, bool estimate);

}  // namespace eomgen::run
