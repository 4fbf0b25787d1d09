// SPDX-License-Identifier: GPL-3.0-or-later
// Configurations in which active constraints follow from one another, for the reason why derivatives end. In: a run,
// the time up to which it is followed. Out: where it comes closest to such a configuration.
#pragma once

#include <optional>
#include <string>

#include "run/runner.hpp"

namespace eomgen::run {

struct LostRank {
  double t = 0;
  std::string constraint;  // it follows from the others there
};

/// The last configuration up to time `until` in which the rows of the active constraints are nearly dependent, relative
/// to the rest of the run. Nothing if there is none.
std::optional<LostRank> find_lost_rank(const RunRequest& request, const RunResult& motion, double until);

/// Throws Error{stage "run"} if the equations of derivatives have ended with an outcome that no limit has caused; up to
/// time `until` the motion may have passed the reason.
void require_bounded(const RunRequest& request, const RunResult& motion, eom::Outcome outcome, double until);

}  // namespace eomgen::run
