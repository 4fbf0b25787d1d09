// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of shipped models at tight tolerances, for comparisons with closed forms.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <string>

#include "support/simulation.hpp"

namespace eomgen::test {

inline constexpr double tight = 1e-11;    // tolerances of the runs
inline constexpr double followed = 1e-8;  // errors at the end of some seconds at these tolerances

inline FinishedRun run_tight(const std::string& name,
                             const std::function<void(pipeline::SimulationRequest&)>& adjust = {}) {
  return run_model(name, [&](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = tight;
    if (adjust) adjust(request);
  });
}

inline void check_sound(const FinishedRun& run) {
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.certificate.pass);
  CHECK(run.simulation.result.power_balance < followed);
  CHECK(run.simulation.result.estimate_note.empty());
}

}  // namespace eomgen::test
