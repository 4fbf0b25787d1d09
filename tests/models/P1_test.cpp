// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("P1: with constant length, E and h_z are conserved to 1e-10 over 100 s") {
  const test::FinishedRun run = test::run_model("P1_spherical_pendulum", [](pipeline::SimulationRequest& request) {
    request.scene = "long";  // DOP853, rtol = atol = 1e-12, 100 s
  });
  CHECK(run.simulation.result.solver == "dop853");
  CHECK(run.simulation.result.t == 100);
  CHECK(run.drift("energy") < 1e-10);
  CHECK(run.drift("momentum.theta") < 1e-10);
}

TEST_CASE("P1: a conical pendulum has constant height and the tension of circular motion") {
  const test::FinishedRun run =
      test::run_model("P1_spherical_pendulum", [](pipeline::SimulationRequest& request) { request.scene = "conical"; });
  const double m = run.parameter("m"), g = run.parameter("g"), L = run.parameter("L");
  const double rate = std::sqrt(2 * g / L);  // phi = 2 pi/3: rate^2 = -g/(L cos phi)
  // The circle is neutrally stable to first order: errors (rtol 1e-9) grow linearly over about 44 radians.
  constexpr double tolerance = 1e-7;
  CHECK(run.final("phi") == doctest::Approx(2 * std::acos(-1.0) / 3).epsilon(tolerance));
  CHECK(run.final("theta") == doctest::Approx(rate * run.simulation.scene.t1).epsilon(tolerance));
  // lambda e_R is the force on the mass; the tension -lambda is m g/|cos phi|.
  CHECK(run.final("reaction.rod") == doctest::Approx(-2 * m * g).epsilon(tolerance));
}

TEST_CASE("P1: with L(t), dE/dt = lambda Ldot along the run") {
  const test::FinishedRun run =
      test::run_model("P1_spherical_pendulum_varying", [](pipeline::SimulationRequest& request) {
        // Rows come from the dense output; the differences below divide its error by 0.01.
        request.overrides.rtol = 1e-14;
        request.overrides.atol = 1e-14;
        request.overrides.every = 0.01;
      });
  CHECK(run.drift("momentum.theta") < 1e-10);
  CHECK(run.simulation.result.power_balance < 1e-9);
  double worst_power = 0, worst_slope = 0, scale = 0;
  const test::Rows& rows = run.rows;
  for (std::size_t i = 4; i + 4 < rows.size(); ++i) {
    const auto energy = [&](int k) { return rows.at(static_cast<std::size_t>(static_cast<int>(i) + k), "energy"); };
    const double power = rows.at(i, "reaction.rod") * rows.at(i, "R_dot");
    // Eighth-order differences over 0.01 s: their own error is some 0.01^8 w^9 E/630 < 1e-13 E.
    const double slope = (4.0 / 5 * (energy(1) - energy(-1)) - 1.0 / 5 * (energy(2) - energy(-2)) +
                          4.0 / 105 * (energy(3) - energy(-3)) - 1.0 / 280 * (energy(4) - energy(-4))) /
                         0.01;
    worst_power = std::max(worst_power, std::abs(rows.at(i, "power") - power));
    worst_slope = std::max(worst_slope, std::abs(slope - power));
    scale = std::max(scale, std::abs(power));
  }
  CHECK(scale > 1);  // the moving rod does work
  CHECK(worst_power / scale < 1e-12);
  CHECK(worst_slope / scale < 1e-9);
}

TEST_CASE("P1: approach I and approach II give the same motion") {
  const auto run = [](pipeline::ApproachChoice approach) {
    return test::run_model("P1_spherical_pendulum_varying", [approach](pipeline::SimulationRequest& request) {
      request.approach = approach;
      request.overrides.rtol = 1e-12;
      request.overrides.atol = 1e-12;
    });
  };
  const test::FinishedRun one = run(pipeline::ApproachChoice::one), two = run(pipeline::ApproachChoice::two);
  CHECK(one.simulation.program.approach == system::Approach::one);
  CHECK(two.simulation.program.approach == system::Approach::two);
  for (const char* name : {"phi", "theta", "phi_dot", "theta_dot", "reaction.rod"}) {
    INFO(name);
    CHECK(one.final(name) == doctest::Approx(two.final(name)).epsilon(1e-9));  // ten seconds at rtol 1e-12
  }
}
