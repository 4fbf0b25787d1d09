// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("P7: both approaches and the reading form agree with the judge to 45 digits at 20 random points") {
  const std::unique_ptr<cli::Derived> derived =
      cli::derive_model(test::model_path("P7_moving_sphere"), cli::ApproachChoice::automatic);
  const program::Program program = cli::make_program(*derived, {});
  const verify::Certificate certificate = cli::certify(*derived, program, {50, 20, 1, nullptr});
  CHECK(certificate.pass);
  CHECK(certificate.points == 20);
  std::size_t against_judge = 0;
  for (const verify::Comparison& c : certificate.comparisons) {
    INFO(c.a, " against ", c.b);
    CHECK(c.pass);
    if (c.a.find("d'Alembert") == std::string::npos && c.b.find("d'Alembert") == std::string::npos) continue;
    CHECK_FALSE(c.shares_code);
    CHECK(c.max_relative_difference < 1e-45);
    ++against_judge;
  }
  CHECK(against_judge >= 6);  // three routes in two approaches
}

TEST_CASE("P7: the reaction along the run is (2.111), and the power balance holds") {
  const test::Finished run = test::run_model("P7_moving_sphere", [](cli::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
    request.overrides.t_end = 2;  // before it comes near the pole
  });
  const double m = run.parameter("m"), g = run.parameter("g"), a = run.parameter("a"), w = run.parameter("w");
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double d = run.rows.at(i, "R"), phi = run.rows.at(i, "phi"), d_ddot = -a * w * w * std::sin(w * run.rows.t[i]);
    const double across = std::sin(phi) * run.rows.at(i, "theta_dot"), down = run.rows.at(i, "phi_dot");
    const double lambda = m * d_ddot - m * d * (across * across + down * down) + m * g * std::cos(phi);
    CHECK(run.rows.at(i, "reaction.sphere") == doctest::Approx(lambda).epsilon(1e-11));
  }
}
