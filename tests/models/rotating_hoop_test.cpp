// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE(
    "rotating_hoop: beta_ddot = (w^2 cos(beta) - g/R) sin(beta), and m R^2 beta_dot^2/2 - m R^2 w^2 sin^2(beta)/2 + U "
    "stays") {
  const test::FinishedRun run = test::run_model("rotating_hoop", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
  });
  const double m = run.parameter("m"), R = run.parameter("R"), g = run.parameter("g"), w = run.parameter("w");
  const auto jacobi = [&](std::size_t i) {
    const double beta = run.rows.at(i, "beta"), rate = run.rows.at(i, "beta_dot");
    return m * R * R / 2 * (rate * rate - std::pow(w * std::sin(beta), 2)) - m * g * R * std::cos(beta);
  };
  double drift = 0, farthest = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    drift = std::max(drift, std::abs(jacobi(i) - jacobi(0)));
    farthest = std::max(farthest, run.rows.at(i, "beta"));
  }
  CHECK(drift < 1e-10 * m * g * R);              // a run at rtol 1e-12 over some twenty swings
  CHECK(farthest > std::acos(g / (R * w * w)));  // it swings about the inclined place of rest
}
