// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "linear_motion.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("S1: the motion of the two masses is that of the linear equations") {
  const test::FinishedRun run = test::run_model("S1_two_masses", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  const auto p = [&run](const char* name) { return run.parameter(name); };
  double worst = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const std::vector<double> x = test::two_masses(p("m1"), p("m2"), p("k1"), p("k2"), run.rows.t[i]);
    worst = std::max({worst, std::abs(run.rows.at(i, "x1") - x[0]), std::abs(run.rows.at(i, "x2") - x[1])});
  }
  CHECK(worst < 1e-11);  // amplitudes of 0.1 over some 13 periods of the faster mode at rtol 1e-12
  CHECK(run.drift("energy") < 1e-11);
}

TEST_CASE("S1: the emitted right-hand side is linear: no sine, no root") {
  const test::FinishedRun run = test::run_model("S1_two_masses");
  const program::Operations& operations = run.simulation.program.functions.front().operations;
  CHECK(operations.trig == 0);
  CHECK(operations.sqrt == 0);
}
