// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("dry_friction_oscillator: it stops at -0.1 after three half oscillations, as in the closed form") {
  const FinishedRun run = run_rough("dry_friction_oscillator");
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() == 4);
  CHECK(events[0].kind == "slip");
  CHECK(events[0].t == 0);
  for (std::size_t i = 1; i < 4; ++i) {
    CHECK(events[i].kind == (i < 3 ? "reverse" : "stick"));
    CHECK(std::abs(events[i].t - static_cast<double>(i) * std::acos(-1.0)) < integration_tolerance);
  }
  CHECK(std::abs(run.final("x") + 0.1) < integration_tolerance);
  CHECK(run.final("x_dot") == 0);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i];
    const int swing = std::min(3, static_cast<int>(t / std::acos(-1.0)));
    const double centre = swing % 2 == 0 ? 0.25 : -0.25, start = swing == 0 ? 1.6 : swing == 1 ? -1.1 : 0.6;
    const double x = swing == 3 ? -0.1 : centre + (start - centre) * std::cos(t - swing * std::acos(-1.0));
    CHECK(std::abs(run.rows.at(i, "x") - x) < integration_tolerance);
  }
  // The energy loss is F times the distance.
  CHECK(run.rows.at(0, "kinetic") == 0);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("dry_friction_oscillator: it sticks within the band, and slides just outside") {
  CHECK(events_of(run_rough("dry_friction_oscillator", "held")).empty());
  CHECK(run_rough("dry_friction_oscillator", "held").final("x") == doctest::Approx(0.2).epsilon(rounding));
  // mu N/k = 0.25 (1 -+ 1e-9) against x = 0.25
  const double N = 2.5;
  CHECK(events_of(run_rough("dry_friction_oscillator", "held", with({{"N", N * 0.8 * (1 + 1e-9)}}))).empty());
  CHECK(!events_of(run_rough("dry_friction_oscillator", "held", with({{"N", N * 0.8 * (1 - 1e-9)}}))).empty());
}
