// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("G1: the same throw in Cartesian, cylindrical and spherical coordinates ends at the end of the parabola") {
  // From (1, 0, 2) with (0.5, 1, 5): each component is a polynomial of t.
  constexpr double t = 2, g = 9.81;
  const double x = 1 + 0.5 * t, y = t, z = 2 + 5 * t - g * t * t / 2;
  constexpr double tolerance = 1e-9;  // for runs at rtol 1e-11
  for (const char* name : {"G1_cartesian", "G1_cylindrical", "G1_spherical"}) {
    INFO(name);
    const test::FinishedRun run = test::run_model(name, [](pipeline::SimulationRequest& request) {
      request.overrides.rtol = 1e-11;
      request.overrides.atol = 1e-12;
      request.overrides.outputs = {"P.position1", "P.position2", "P.position3", "energy"};
    });
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(run.final("P.position1") == doctest::Approx(x).epsilon(tolerance));
    CHECK(run.final("P.position2") == doctest::Approx(y).epsilon(tolerance));
    CHECK(run.final("P.position3") == doctest::Approx(z).epsilon(tolerance));
    CHECK(run.drift("energy") < tolerance);
  }
}
