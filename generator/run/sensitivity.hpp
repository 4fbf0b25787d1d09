// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives of the end of a run by parameters and initial values, by the variational equations (variational.hpp). In:
// the run and its result, directions of change. Out: the derivatives with error estimates.
#pragma once

#include "run/direction.hpp"
#include "run/runner.hpp"

namespace eomgen::run {

struct Sensitivity {
  std::string of;             // the direction
  std::vector<double> value;  // per state at the end
  double of_time = 0;         // of the time of the end
  std::vector<double> error;  // estimates; empty if not requested
  double error_of_time = 0;
};

struct Sensitivities {
  std::string solver;
  eom::Outcome outcome = eom::Outcome::done;
  double t = 0;
  std::vector<Sensitivity> list;
  eom::Statistics statistics;
  std::string estimate_note;
};

/// Sensitivities of the end of the run with this result. Requires jac and jac_p of `request.code`, and jac_u if it has
/// inputs. Throws Error{stage "run"} for what is not differentiated, and if the end of x differs from that of the run.
Sensitivities integrate_sensitivities(const RunRequest& request, const RunResult& result,
                                      const std::vector<Direction>& directions, bool estimate);

}  // namespace eomgen::run
