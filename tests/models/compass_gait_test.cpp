// SPDX-License-Identifier: GPL-3.0-or-later
// The gait of a compass walker against published numbers, and numbers computed apart: by Newton's iteration on the map
// of one step, with equations of motion and an integrator that share no code with eomgen.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

/// Rows of the gait are followed over five steps, each of which reduces errors to 0.58 of them.
constexpr double gait_tolerance = 1e-9;

std::vector<run::RunEvent> named(const std::vector<run::RunEvent>& events, const std::string& name,
                                 const std::string& kind) {
  std::vector<run::RunEvent> result;
  std::copy_if(events.begin(), events.end(), std::back_inserter(result),
               [&](const run::RunEvent& event) { return event.name == name && event.kind == kind; });
  return result;
}

}  // namespace

// Published for 3 degrees: a step of 0.734 s and 0.535 m, and the start (0.2187, -0.3234, -1.0918, -0.3772) in four
// digits. The other digits are computed apart.
TEST_CASE("compass_gait: the gait of period one on 3 degrees returns to its start, at the published period") {
  constexpr double period = 0.7347209621553616, stance = 0.2186688029389919, swing = -0.3233885580586492;
  constexpr double stance_dot = -1.0918266774895762, swing_dot = -0.3771815584032684;
  const FinishedRun run = run_rough("compass_gait");
  CHECK(run.simulation.certificate.pass);
  const std::vector<run::RunEvent> strikes = named(events_of(run), "heel_strike", "reset");
  REQUIRE(strikes.size() == 5);
  for (std::size_t k = 0; k < strikes.size(); ++k)
    CHECK(std::abs(strikes[k].t - period * static_cast<double>(k + 1)) < gait_tolerance);
  std::size_t steps = 0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    if (run.rows.t[i] != run.rows.t[i - 1]) continue;
    CHECK(std::abs(run.rows.at(i, "stance") - stance) < gait_tolerance);
    CHECK(std::abs(run.rows.at(i, "swing") - swing) < gait_tolerance);
    CHECK(std::abs(run.rows.at(i, "stance_dot") - stance_dot) < gait_tolerance);
    CHECK(std::abs(run.rows.at(i, "swing_dot") - swing_dot) < gait_tolerance);
    ++steps;
  }
  CHECK(steps == strikes.size());
  // The four digits and three digits of the publication.
  CHECK(std::abs(period - 0.734) < 1e-3);
  CHECK(std::abs(2 * (run.parameter("a") + run.parameter("b")) * std::sin((stance - swing) / 2) - 0.535) < 1e-3);
}

TEST_CASE("compass_gait: a walk that starts 4 % too slow comes to the same gait") {
  const FinishedRun run = run_rough("compass_gait", "default", [](pipeline::SimulationRequest& request) {
    request.overrides.values["stance_dot"] = symbolic::Rational(-105) / 100;
    request.overrides.t_end = 30;
  });
  const std::vector<run::RunEvent> strikes = named(events_of(run), "heel_strike", "reset");
  REQUIRE(strikes.size() > 35);
  // The slowest multiplier of the map is 0.58: after 35 steps 1e-8 of the 0.04 s is left at most.
  CHECK(std::abs(strikes.back().t - strikes[strikes.size() - 2].t - 0.7347209621553616) < 1e-8);
}
