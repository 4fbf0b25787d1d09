// SPDX-License-Identifier: GPL-3.0-or-later
// The projectile motion of the models of coordinates: from (1, 0, 2) with velocity (0.5, 1, 5). Each component is a
// polynomial of t.
#pragma once

#include <doctest/doctest.h>

#include <string>

#include "support/simulation.hpp"

namespace eomgen::test {

/// Runs the model and compares its final state with the parabola.
inline FinishedRun check_projectile(const std::string& model, std::vector<std::string> outputs = {}) {
  INFO(model);
  constexpr double tolerance = 1e-9;  // of runs at rtol 1e-11
  outputs.insert(outputs.end(), {"P.position1", "P.position2", "P.position3"});
  FinishedRun run = run_model(model, [&](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-11;
    request.overrides.atol = 1e-12;
    request.overrides.outputs = outputs;
  });
  const double t = run.simulation.scene.t1, g = run.parameter("g");
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(t == 2);
  CHECK(run.final("P.position1") == doctest::Approx(1 + 0.5 * t).epsilon(tolerance));
  CHECK(run.final("P.position2") == doctest::Approx(t).epsilon(tolerance));
  CHECK(run.final("P.position3") == doctest::Approx(2 + 5 * t - g * t * t / 2).epsilon(tolerance));
  CHECK(run.drift("energy") < tolerance);
  return run;
}

}  // namespace eomgen::test
