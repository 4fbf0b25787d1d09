// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <numbers>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

using std::numbers::pi;
constexpr double cycle_time = 1e-10;  // rtol 1e-12; the closed form is exact

}  // namespace

TEST_CASE("stick_slip_belt: it sticks for 5 and slips for 2(pi - atan 2.5), again and again") {
  const FinishedRun run = run_rough("stick_slip_belt");
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() >= 12);
  double t = 5;
  for (std::size_t i = 0; i < events.size(); ++i) {
    CHECK(events[i].kind == (i % 2 == 0 ? "slip" : "stick"));
    CHECK(events[i].name == "belt");
    CHECK(std::abs(events[i].t - t) < cycle_time);
    t += i % 2 == 0 ? 2 * (pi - std::atan(2.5)) : 5;
  }
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    if (run.rows.at(i, "mode.belt") == 0) CHECK(run.rows.at(i, "x_dot") == doctest::Approx(0.2).epsilon(rounding));
    CHECK(std::abs(run.rows.at(i, "friction.belt.1")) <= 1 + 1e-11);
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("stick_slip_belt: thrown faster than the belt it is braked, then dragged, and falls into the same cycle") {
  const FinishedRun run = run_rough("stick_slip_belt", "thrown");
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() >= 8);
  CHECK(events[0].kind == "reverse");
  // x = -0.5 + 0.5 cos t + 1.5 sin t while it is faster than the belt: 1.5 cos t - 0.5 sin t = 0.2.
  CHECK(std::abs(events[0].t - (std::acos(0.2 / std::hypot(1.5, 0.5)) - std::atan2(0.5, 1.5))) < cycle_time);
  CHECK(events[1].kind == "stick");
  for (std::size_t i = 2; i + 1 < events.size(); ++i) {
    const double expected = i % 2 == 0 ? 2 * (pi - std::atan(2.5)) : 5;
    CHECK(std::abs(events[i + 1].t - events[i].t - expected) < cycle_time);
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}
