// SPDX-License-Identifier: GPL-3.0-or-later
// With psi the angle between velocity and downhill, v sin(psi)/tan(psi/2)^k and v (k + cos psi) - g sin(beta) (1 - k^2)
// t are constant, k = mu_d/tan(beta): time and place of the stop follow.
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("rough_incline_puck: thrown across the slope it stops at the place and time of the closed form") {
  const FinishedRun run = run_rough("rough_incline_puck");
  const double g = run.parameter("g"), beta = run.parameter("beta"), k = run.parameter("mu_d") / std::tan(beta),
               down = g * std::sin(beta);
  const double v0 = std::hypot(0.5, 1.5), psi0 = std::atan2(1.5, -0.5), u0 = std::tan(psi0 / 2);
  REQUIRE(k > 1);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "stick");
  CHECK(std::abs(events_of(run)[0].t - v0 * (k + std::cos(psi0)) / (down * (k * k - 1))) < integration_tolerance);
  const double C = v0 * std::sin(psi0) / std::pow(u0, k), scale = C * C / down;
  const double x = scale / 4 * (std::pow(u0, 2 * k - 2) / (2 * k - 2) - std::pow(u0, 2 * k + 2) / (2 * k + 2));
  const double y = scale / 2 * (std::pow(u0, 2 * k - 1) / (2 * k - 1) + std::pow(u0, 2 * k + 1) / (2 * k + 1));
  CHECK(std::abs(run.final("x") - x) < integration_tolerance);
  CHECK(std::abs(run.final("y") - y) < integration_tolerance);
  CHECK(run.final("x_dot") == 0);
  CHECK(run.final("y_dot") == 0);
  CHECK(run.final("friction.incline.1") == doctest::Approx(-run.parameter("m") * down).epsilon(rounding));  // held
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    if (run.rows.t[i] >= events_of(run)[0].t) continue;
    const double vx = run.rows.at(i, "x_dot"), vy = run.rows.at(i, "y_dot"), v = std::hypot(vx, vy),
                 f = run.parameter("mu_d") * run.parameter("m") * g * std::cos(beta);
    CHECK(run.rows.at(i, "friction.incline.1") == doctest::Approx(-f * vx / v).epsilon(1e-11).scale(1));
    CHECK(run.rows.at(i, "friction.incline.2") == doctest::Approx(-f * vy / v).epsilon(1e-11).scale(1));
  }
}

TEST_CASE("rough_incline_puck: on the level it goes straight, for v0^2/(2 mu g)") {
  const FinishedRun run = run_rough("rough_incline_puck", "level");
  const double deceleration = run.parameter("mu_d") * run.parameter("g"), way = 1.5 * 1.5 / (2 * deceleration);
  REQUIRE(events_of(run).size() == 1);
  CHECK(std::abs(events_of(run)[0].t - 1.5 / deceleration) < integration_tolerance);
  CHECK(std::abs(run.final("x") - 0.6 * way) < integration_tolerance);
  CHECK(std::abs(run.final("y") - 0.8 * way) < integration_tolerance);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("rough_incline_puck: from rest it slides straight down if tan(beta) exceeds mu_s, and stays otherwise") {
  const FinishedRun run = run_rough("rough_incline_puck", "steep");
  const double g = run.parameter("g"), beta = run.parameter("beta");
  const double a = g * (std::sin(beta) - run.parameter("mu_d") * std::cos(beta));
  REQUIRE(!events_of(run).empty());
  CHECK(events_of(run)[0].kind == "slip");
  CHECK(std::abs(run.final("x") - 2 * a) < integration_tolerance);  // a t^2/2 at t = 2
  CHECK(std::abs(run.final("y")) < integration_tolerance);
  CHECK(events_of(run_rough("rough_incline_puck", "steep", with({{"mu_s", std::tan(beta) * (1 + 1e-9)}}))).empty());
  CHECK(!events_of(run_rough("rough_incline_puck", "steep", with({{"mu_s", std::tan(beta) * (1 - 1e-9)}}))).empty());
}

TEST_CASE("rough_incline_puck: fixed steps that are longer than the slip lasts stop it all the same") {
  for (const double step : {0.7, 2.0}) {
    CAPTURE(step);
    const FinishedRun run = run_rough("rough_incline_puck", "level", [&](pipeline::SimulationRequest& request) {
      request.overrides.solver = "rk4";
      request.overrides.step = step;
      request.overrides.t_end = 4;
    });
    const double deceleration = run.parameter("mu_d") * run.parameter("g"), way = 1.5 * 1.5 / (2 * deceleration);
    REQUIRE(events_of(run).size() == 1);
    CHECK(std::abs(events_of(run)[0].t - 1.5 / deceleration) < integration_tolerance);
    CHECK(std::abs(run.final("x") - 0.6 * way) < integration_tolerance);
    CHECK(std::abs(run.final("y") - 0.8 * way) < integration_tolerance);
  }
}
