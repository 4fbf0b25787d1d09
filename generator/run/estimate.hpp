// SPDX-License-Identifier: GPL-3.0-or-later
// How far off the end of a run is: further runs, and what fixed steps hide from them.
#pragma once

#include <eom/run_types.hpp>
#include <string>

#include "run/resolution.hpp"
#include "run/runner.hpp"

namespace eomgen::run {

/// Fills the estimates of `result`, and a note where they are not to be trusted. `first`: the run, in the model's own
/// charts; resolution: of fixed steps, else null.
void estimate_error(const RunRequest& request, const std::string& solver, const eom::Result& first,
                    const eom::Options& options, Resolution* resolution, RunResult& result);

}  // namespace eomgen::run
