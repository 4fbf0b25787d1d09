// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/simulation.hpp"

using namespace eomgen;

namespace {

// Accelerations of some 10 m/s^2 as differences of forces that are 100 times as large, computed twice in binary64.
constexpr double rounding_of_run = 1e-10;
// 4 s at rtol 1e-10.
constexpr double followed_ride = 1e-8;

test::FinishedRun run_road(const char* scene) {
  return test::run_model("quarter_car", [scene](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.rtol = request.overrides.atol = 1e-10;
  });
}

}  // namespace

// With T = M z'^2/2 + m ((z' - L a' cos(a))^2 + (L a' sin(a))^2)/2, the compression w = z - L sin(a) - road of the tyre
// and the length d of the strut, which a alone determines:
//   (M + m) z'' - m L cos(a) a'' = -(M + m) g - m L sin(a) a'^2 - kt w
//   -m L cos(a) z'' + m L^2 a'' = (m g + kt w) L cos(a) + S dd/da,  S = -k (d - l0) - c d' - cs z'.
TEST_CASE("quarter_car: the accelerations are those of Lagrange's equations by hand, and the energy closes") {
  const test::FinishedRun run = run_road("default");
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double M = p("M"), m = p("m"), g = p("g"), L = p("L"), q = p("p"), b = p("b"), h = p("h");
  REQUIRE(run.rows.size() > 100);
  double stroke = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const auto at = [&](const char* name) { return run.rows.at(i, name); };
    const double C = std::cos(at("a")), S = std::sin(at("a")), a1 = at("a_dot");
    const double road = p("H") / 2 * (1 - std::cos(2 * std::numbers::pi * run.rows.t[i] / p("T")));
    const double d = std::hypot(q * C - b, q * S + h), slope = q * (b * S + h * C) / d;
    const double strut = -p("k") * (d - p("l0")) - p("c") * slope * a1 - p("cs") * at("z_dot");
    const double w = at("z") - L * S - road;
    const double f1 = -(M + m) * g - m * L * S * a1 * a1 - p("kt") * w,
                 f2 = (m * g + p("kt") * w) * L * C + strut * slope;
    const double A = M + m, B = -m * L * C, D = m * L * L, det = A * D - B * B;
    CHECK(at("z_ddot") == doctest::Approx((D * f1 - B * f2) / det).epsilon(rounding_of_run).scale(10));
    CHECK(at("a_ddot") == doctest::Approx((A * f2 - B * f1) / det).epsilon(rounding_of_run).scale(10));
    stroke = std::max(stroke, std::abs(d - p("d0")));
  }
  CHECK(stroke > 1e-3);  // the strut moves
  CHECK(run.simulation.result.power_balance < followed_ride);
  CHECK(run.simulation.certificate.pass);
}

TEST_CASE("quarter_car: on a flat road the strut carries M g L cos(a)/(dd/da), the tyre (M + m) g, and nothing moves") {
  const test::FinishedRun run = run_road("flat");
  CHECK(std::abs(run.final("a") - run.parameter("a0")) < followed_ride);
  CHECK(std::abs(run.final("z") - run.parameter("z0")) < followed_ride);
  CHECK(std::abs(run.final("z_dot")) < followed_ride);
}
