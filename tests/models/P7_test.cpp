// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("P7: both approaches and the display form agree with the oracle to 45 digits at 20 random points") {
  const std::unique_ptr<pipeline::DerivedModel> derived =
      pipeline::derive_model(test::model_at(test::model_path("P7_moving_sphere")), pipeline::ApproachChoice::automatic);
  const program::Program program = pipeline::make_program(*derived, {});
  const verify::Certificate certificate = pipeline::certify(*derived, program, {50, 20, 1, nullptr});
  CHECK(certificate.pass);
  CHECK(certificate.points == 20);
  std::size_t against_oracle = 0;
  for (const verify::Comparison& c : certificate.comparisons) {
    INFO(c.a, " against ", c.b);
    CHECK(c.pass);
    if (c.a.find("d'Alembert") == std::string::npos && c.b.find("d'Alembert") == std::string::npos) continue;
    CHECK_FALSE(c.shares_code);
    CHECK(c.max_relative_difference < 1e-45);
    ++against_oracle;
  }
  CHECK(against_oracle >= 6);  // three formulations in two approaches
}

TEST_CASE("P7: the reaction along the run is (2.111), and the power balance holds") {
  const test::FinishedRun run = test::run_model("P7_moving_sphere", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
    request.overrides.t_end = 2;  // before it comes near the pole
  });
  const double m = run.parameter("m"), g = run.parameter("g"), a = run.parameter("a"), w = run.parameter("w");
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double d = run.rows.at(i, "R"), phi = run.rows.at(i, "phi"),
                 d_ddot = -a * w * w * std::sin(w * run.rows.t[i]);
    const double across = std::sin(phi) * run.rows.at(i, "theta_dot"), down = run.rows.at(i, "phi_dot");
    const double lambda = m * d_ddot - m * d * (across * across + down * down) + m * g * std::cos(phi);
    CHECK(run.rows.at(i, "reaction.sphere") == doctest::Approx(lambda).epsilon(1e-11));
  }
}

TEST_CASE("P7: with a velocity constraint both reactions are those of (2.114)") {
  const test::FinishedRun run = test::run_model("P7_moving_sphere_pfaffian", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
  });
  const auto p = [&](const char* name) { return run.parameter(name); };
  const double m = p("m"), g = p("g"), D = p("D"), a = p("a"), w = p("w"), kappa = p("kappa"), eta = p("eta"),
               nu = p("nu");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i], d = run.rows.at(i, "R"), d1 = a * w * std::cos(w * t),
                 d2 = -a * w * w * std::sin(w * t);
    const double phi = run.rows.at(i, "phi"), phi1 = run.rows.at(i, "phi_dot");
    const double theta = run.rows.at(i, "theta"), theta1 = run.rows.at(i, "theta_dot");
    const double s = std::sin(phi), c = std::cos(phi), f1 = -kappa * std::sin(theta - w * t);  // f2 = 1, f3 = -eta
    // The equations of phi and theta read I phi'' = Q_phi + lambda2 and I s^2 theta'' = Q_theta + lambda2 f1.
    const double I = m * d * d, Q_phi = I * s * c * theta1 * theta1 - 2 * m * d * d1 * phi1 + m * g * d * s;
    const double Q_theta = D * d * d * s - 2 * I * s * c * phi1 * theta1 - 2 * m * d * s * s * d1 * theta1;
    const double f1_dot = -kappa * std::cos(theta - w * t) * (theta1 - w);
    const double rest = f1_dot * theta1 - eta * d2 + nu * w * std::sin(w * t);  // phi'' + f1 theta'' + rest = 0
    const double lambda2 = -(rest + Q_phi / I + f1 * Q_theta / (I * s * s)) / (1 / I + f1 * f1 / (I * s * s));
    const double lambda1 = m * d2 - m * d * (phi1 * phi1 + s * s * theta1 * theta1) + m * g * c + eta * lambda2;
    CHECK(run.rows.at(i, "reaction.tilt") == doctest::Approx(lambda2).epsilon(1e-10));
    CHECK(run.rows.at(i, "reaction.sphere") == doctest::Approx(lambda1).epsilon(1e-10));
    CHECK(std::abs(phi1 + f1 * theta1 - eta * d1 - nu * std::cos(w * t)) < 1e-11);  // rows lie between steps
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}
