// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

// Newton's and Euler's equations. The foot is at l = h (sin(b), -cos(b)) from the centre of mass and moves with
// v + b' E3 x l; the mount's force on it is -k_i x_i - c_i v_i, its moment -kr sin(b) cos(b) - cr b'.
TEST_CASE("engine_mount: the accelerations are those of the force and the moment of the mount by hand") {
  const test::FinishedRun run = test::run_model("engine_mount", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-10;
  });
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double h = p("h"), m = p("m"), w = p("w");
  REQUIRE(run.rows.size() > 100);
  double rolled = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const auto at = [&](const char* name) { return run.rows.at(i, name); };
    // Some 10 m/s^2 and rad/s^2, as differences of forces that are 100 times as large.
    const auto near = [](double x) { return doctest::Approx(x).epsilon(1e-10).scale(10); };
    const double t = run.rows.t[i], C = std::cos(at("b")), S = std::sin(at("b")), b1 = at("b_dot");
    const double f1 = -p("k1") * (at("x") + h * S) - p("c1") * (at("x_dot") + h * C * b1),
                 f2 = -p("k2") * (at("y") - h * C) - p("c2") * (at("y_dot") + h * S * b1);
    CHECK(at("x_ddot") == near((f1 + p("F") * std::cos(w * t)) / m));
    CHECK(at("y_ddot") == near((f2 + p("F") * std::sin(w * t)) / m - p("g")));
    const double moment = h * (S * f2 + C * f1) - p("kr") * S * C - p("cr") * b1;
    CHECK(at("b_ddot") == near((moment + p("M") * (1 + std::cos(2 * w * t))) / p("J")));
    rolled = std::max(rolled, std::abs(at("b")));
  }
  CHECK(rolled > 1e-3);
  CHECK(run.simulation.result.power_balance < 1e-8);
  CHECK(run.simulation.certificate.pass);
}

TEST_CASE("engine_mount: with the engine off it sags by m g/k2, and nothing moves") {
  const test::FinishedRun run =
      test::run_model("engine_mount", [](pipeline::SimulationRequest& request) { request.scene = "still"; });
  const double sag = run.parameter("m") * run.parameter("g") / run.parameter("k2");
  CHECK(std::abs(run.final("y") - (run.parameter("h") - sag)) < 1e-9);
  for (const char* rest : {"x", "b", "x_dot", "y_dot", "b_dot"}) CHECK(std::abs(run.final(rest)) < 1e-9);
}
