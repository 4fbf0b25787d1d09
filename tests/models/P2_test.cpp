// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/elliptic.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("P2: with constant length it follows the elliptic functions, and both reactions are correct") {
  const test::FinishedRun run = test::run_model("P2_planar_pendulum", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  const double m = run.parameter("m"), g = run.parameter("g"), L = run.parameter("L");
  double worst_angle = 0, worst_rod = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const test::Swing swing = test::pendulum_from_rest(1.0, std::sqrt(g / L), run.rows.t[i]);
    worst_angle = std::max(worst_angle, std::abs(run.rows.at(i, "theta") - swing.angle));
    // The rod pulls inwards: lambda = -(m L w^2 + m g cos(theta)).
    const double rod = -(m * L * swing.rate * swing.rate + m * g * std::cos(swing.angle));
    worst_rod = std::max(worst_rod, std::abs(run.rows.at(i, "reaction.rod") - rod));
    CHECK(run.rows.at(i, "reaction.plane") == 0);  // no force out of the plane
  }
  CHECK(run.rows.size() > 400);
  CHECK(worst_angle < 1e-10);  // ten seconds at rtol 1e-12, dense output included
  CHECK(worst_rod < 1e-9);
}

TEST_CASE("P2: with variable length it satisfies the power balance and the reaction of (2.43)") {
  const test::FinishedRun run = test::run_model("P2_planar_pendulum_varying", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
  });
  const double m = run.parameter("m"), g = run.parameter("g"), a = run.parameter("a"), w = run.parameter("w");
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double L = run.rows.at(i, "r"), rate = run.rows.at(i, "theta_dot"), theta = run.rows.at(i, "theta");
    const double L_ddot = -a * w * w * std::cos(w * run.rows.t[i]);
    const double rod = m * (L_ddot - L * rate * rate) - m * g * std::cos(theta);
    CHECK(run.rows.at(i, "reaction.rod") == doctest::Approx(rod).epsilon(1e-12));  // an identity of the same state
  }
}
