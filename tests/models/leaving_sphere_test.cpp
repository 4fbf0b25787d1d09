// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

namespace {

// On the sphere from rest at the top phi_dot = 2 sqrt(g/a) sin(phi/2), so that t is sqrt(a/g) log tan(phi/4).
double time_between(double phi0, double phi1, double a, double g) {
  return std::sqrt(a / g) * std::log(std::tan(phi1 / 4) / std::tan(phi0 / 4));
}

// Steps at rtol 1e-12.
constexpr double leaving_tolerance = 1e-11;

test::FinishedRun run_scene(const char* scene, const char* solver = "dop853") {
  return test::run_model("leaving_sphere", [=](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.solver = solver;
    request.overrides.rtol = request.overrides.atol = 1e-12;
    request.overrides.every = 0.1;
  });
}

}  // namespace

TEST_CASE("leaving_sphere: it leaves at cos(phi) = 2/3, at the time of the closed form") {
  for (const char* solver : {"dopri5", "tsit5", "dop853"}) {
    const test::FinishedRun run = run_scene("default", solver);
    const run::RunResult& result = run.simulation.result;
    const double a = run.parameter("a"), g = run.parameter("g");
    CHECK(result.outcome == eom::Outcome::stopped_by_event);
    CHECK(std::abs(std::cos(run.final("phi")) - 2.0 / 3) < leaving_tolerance);
    CHECK(std::abs(run.final("reaction.sphere")) < leaving_tolerance);
    const double exact = time_between(0.1, std::acos(2.0 / 3), a, g);
    CHECK(std::abs(result.t - exact) < leaving_tolerance);
    REQUIRE(result.events.size() == 2);
    CHECK(result.events[0].kind == "custom");
    CHECK(result.events[0].name == "halfway");
    CHECK(std::abs(result.events[0].t - time_between(0.1, std::acos(5.0 / 6), a, g)) < leaving_tolerance);
    CHECK(result.events[1].kind == "stop");
    CHECK(result.events[1].name == "leaves");
    CHECK(result.events[1].t == result.t);
  }
}

TEST_CASE("leaving_sphere: rows are in order of time, with those of the events among them") {
  const test::FinishedRun run = run_scene("default");
  const run::RunResult& result = run.simulation.result;
  REQUIRE(run.rows.size() == 7);  // 0, 0.1, .. 0.4, halfway (0.4006), the end
  for (std::size_t i = 1; i < run.rows.size(); ++i) CHECK(run.rows.t[i] > run.rows.t[i - 1]);
  for (std::size_t i = 0; i < 5; ++i) CHECK(run.rows.t[i] == static_cast<double>(i) * 0.1);
  CHECK(run.rows.t[5] == result.events[0].t);
  CHECK(std::abs(std::cos(run.rows.at(5, "phi")) - 5.0 / 6) < leaving_tolerance);
  CHECK(run.rows.t[6] == result.t);
}

TEST_CASE("leaving_sphere: `stop` of a scene ends it at an event that is only recorded elsewhere") {
  const test::FinishedRun run = run_scene("half");
  CHECK(run.simulation.result.outcome == eom::Outcome::stopped_by_event);
  CHECK(std::abs(std::cos(run.final("phi")) - 5.0 / 6) < leaving_tolerance);
  REQUIRE(run.simulation.result.events.size() == 1);
  CHECK(run.simulation.result.events[0].kind == "stop");
}

TEST_CASE(
    "leaving_sphere: the estimate of a run that an event ends has the time of the stop, within ten times of the "
    "truth") {
  const test::FinishedRun run = test::run_model("leaving_sphere", [](pipeline::SimulationRequest& request) {
    request.overrides.solver = "dopri5";
    request.overrides.rtol = request.overrides.atol = 1e-7;
  });
  const double exact = time_between(0.1, std::acos(2.0 / 3), run.parameter("a"), run.parameter("g"));
  const double error = std::abs(run.simulation.result.t - exact);
  CHECK(error > 0.1 * run.error("t"));
  CHECK(error < 10 * run.error("t"));
  CHECK(run.simulation.result.estimate_note.empty());
}
