// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

TEST_CASE("R7: energy and H_O are conserved with the full attraction of second order") {
  const test::FinishedRun run = test::run_model("R7_satellite", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  CHECK(run.drift("energy") < 1e-11);
  double worst = 0;
  for (const char* name : {"HO1", "HO2", "HO3"}) {
    for (std::size_t i = 0; i < run.rows.size(); ++i)
      worst = std::max(worst, std::abs(run.rows.at(i, name) - run.rows.at(0, name)));
  }
  CHECK(worst < 1e-11);
  for (const char* h : {"angular_momentum.E1", "angular_momentum.E2", "angular_momentum.E3"})
    CHECK(run.drift(h) < 1e-11);
  // The orbit feels the body's attitude: R moves by more than Kepler's ellipse would at these moments of inertia of 0.5
  // %.
  CHECK(std::abs(run.final("R") - 1) > 1e-4);
}

// (9.31) has the moment 3GM/R^3 c x Jc on the right, (9.32) the slope of U: the oracle uses force and moment, the
// formulations use U.
TEST_CASE("R7: force and moment of (7.72), (9.31) and the potential (7.71), (9.32) give the same equations") {
  const model::Model model = model::read_model(test::model_path("R7_satellite"));
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const verify::Certificate c = verify::verify(m, {50, 20, 7});
  CHECK(c.pass);
  bool seen = false;
  for (const verify::Comparison& row : c.comparisons) {
    if (row.a != "lagrange I" || row.shares_code) continue;
    seen = true;
    CHECK(row.max_relative_difference < 1e-45);
  }
  CHECK(seen);
}
