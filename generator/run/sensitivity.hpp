// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives of the end state of a run by parameters and initial values: the variational equations
//   s' = df/dx s + df/dp dp,   s(t0) = dx0
// are integrated together with x' = f (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section
// I.14), with df/dx and df/dp of the emitted code, under the same error control.
#pragma once

#include "run/runner.hpp"

namespace eomgen::run {

/// A direction of change: derivatives of the parameters and of the start along it.
struct Direction {
  std::string name;
  double scale = 1;        // the size of the changed quantity: the error control sees s times this
  std::vector<double> dp;  // per parameter of the model, dependent ones too
  std::vector<double> dx;  // per state
};

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

/// Sensitivities at the time `t_end` that the run has reached. Requires jac and jac_p of `request.code`. Throws
/// Error{stage "run"} if the equations change during the run (contacts): the derivative jumps there.
Sensitivities integrate_sensitivities(const RunRequest& request, const std::string& solver, double t_end,
                                      const std::vector<Direction>& directions, bool estimate);

}  // namespace eomgen::run
