// SPDX-License-Identifier: GPL-3.0-or-later
// (3.68), with the pull and the dashpots of Ex 3.3 and 3.4.
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Line {
  explicit Line(const FinishedRun& run) {
    const auto p = [&](const char* name) { return run.parameter(name); };
    m1 = p("m1"), m2 = p("m2"), k1 = p("k1"), k2 = p("k2"), c1 = p("c1"), c2 = p("c2"), P0 = p("P0"), w = p("w"),
    g = p("g");
    mu_s = p("mu_s"), mu_d = p("mu_d");
  }
  /// Force along the line without friction.
  double on1(double, const double* x) const { return -k1 * x[0] - k2 * (x[0] - x[1]) - c1 * x[2] - c2 * (x[2] - x[3]); }
  double on2(double t, const double* x) const {
    return -k2 * (x[1] - x[0]) - c2 * (x[3] - x[2]) + P0 * std::sin(w * t);
  }
  double m1, m2, k1, k2, c1, c2, P0, w, g, mu_s, mu_d;
};

double sign(double v) { return v > 0 ? 1 : -1; }

}  // namespace

TEST_CASE(
    "S3: at random states the equations are (3.68) with applied force and dashpots, and normal forces are weights") {
  const FinishedRun run = run_rough("S3_rough_line", "free");
  const FinishedRun pulled = run_rough("S3_rough_line");
  for (const FinishedRun* of : {&run, &pulled}) {
    const Line line(*of);
    StateEvaluation derived(*of, "S3_rough_line");
    UniformSampler draw;
    for (int i = 0; i < 30; ++i) {
      const double t = draw(0, 9);
      const double x[4] = {draw(-2, 2), draw(-2, 2), draw(-3, 3), draw(-3, 3)};
      REQUIRE(derived.slide(t, {x[0], x[1], x[2], x[3]}));
      CHECK(derived.dx[2] ==
            doctest::Approx(line.on1(t, x) / line.m1 - line.mu_d * line.g * sign(x[2])).epsilon(rounding).scale(30));
      CHECK(derived.dx[3] ==
            doctest::Approx(line.on2(t, x) / line.m2 - line.mu_d * line.g * sign(x[3])).epsilon(rounding).scale(30));
      CHECK(derived.output("reaction.line1.1") == doctest::Approx(0));
      CHECK(derived.output("reaction.line1.2") == doctest::Approx(line.m1 * line.g).epsilon(rounding));
      CHECK(derived.output("reaction.line2.2") == doctest::Approx(line.m2 * line.g).epsilon(rounding));
    }
  }
}

TEST_CASE("S3: released, the second mass makes one half oscillation while the first sticks, then both stick") {
  const FinishedRun run = run_rough("S3_rough_line", "free");
  const Line line(run);
  REQUIRE(events_of(run).size() == 2);
  CHECK(events_of(run)[0].t == 0);
  CHECK(events_of(run)[0].name == "line2");
  CHECK(events_of(run)[1].kind == "stick");
  CHECK(std::abs(events_of(run)[1].t - std::acos(-1.0) * std::sqrt(line.m2 / line.k2)) < integration_tolerance);
  const double centre = 0.3 + line.mu_d * line.m2 * line.g / line.k2;
  CHECK(std::abs(run.final("x2") - (2 * centre - 1)) < integration_tolerance);
  CHECK(run.final("x1") == doctest::Approx(0.3).epsilon(rounding));
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("S3: under the applied force each mass sticks and slides by hand-written equations and the static law") {
  const FinishedRun run = run_rough("S3_rough_line");
  const Line line(run);
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() > 20);
  // At rest until P0 sin(w t) is what friction holds.
  CHECK(std::abs(events[0].t - std::asin(line.mu_s * line.m2 * line.g / line.P0) / line.w) < integration_tolerance);
  int way[2] = {0, 0};
  const auto rates = [&](double t, const double* x, double* dx) {
    dx[0] = way[0] == 0 ? 0 : x[2], dx[1] = way[1] == 0 ? 0 : x[3];
    dx[2] = way[0] == 0 ? 0 : line.on1(t, x) / line.m1 - line.mu_d * line.g * way[0];
    dx[3] = way[1] == 0 ? 0 : line.on2(t, x) / line.m2 - line.mu_d * line.g * way[1];
  };
  HandWrittenMotion hand(rates, 0, {0, 0, 0, 0});
  for (const run::RunEvent& event : events) {
    hand.advance_to(event.t);
    const std::size_t j = event.name == "line1" ? 0 : 1;
    const double pull = j == 0 ? line.on1(event.t, hand.x.data()) : line.on2(event.t, hand.x.data());
    const double limit = line.mu_s * (j == 0 ? line.m1 : line.m2) * line.g;
    CAPTURE(event.t);
    if (event.kind == "slip") {
      CHECK(way[j] == 0);
      CHECK(std::abs(std::abs(pull) - limit) < 1e-8);  // 40 N/s times the error of the time
      way[j] = pull > 0 ? 1 : -1;
    } else {
      CHECK(std::abs(hand.x[2 + j]) < 1e-8);
      CHECK(event.kind == (std::abs(pull) <= limit ? "stick" : "reverse"));
      way[j] = event.kind == "stick" ? 0 : -way[j];
      hand.x[2 + j] = 0;
    }
  }
  hand.advance_to(run.simulation.result.t);
  CHECK(std::abs(run.final("x1") - hand.x[0]) < 1e-9);
  CHECK(std::abs(run.final("x2") - hand.x[1]) < 1e-9);
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    CHECK(std::abs(run.rows.at(i, "friction.line1.1")) <= line.mu_s * line.m1 * line.g * (1 + 1e-9));
    CHECK(std::abs(run.rows.at(i, "friction.line2.1")) <= line.mu_s * line.m2 * line.g * (1 + 1e-9));
  }
}

TEST_CASE("S3: a run at any tolerance continues when a mass starts from rest with rounding errors") {
  // Velocities of 1e-17 with a small atol used to give first steps below the rounding of t.
  for (const char* solver : {"dopri5", "tsit5", "dop853"}) {
    const FinishedRun run = run_rough("S3_rough_line", "default", [=](pipeline::SimulationRequest& request) {
      request.overrides.solver = solver;
      request.overrides.rtol = 1e-9;
      request.overrides.atol = 1e-14;
    });
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(run.simulation.result.statistics.steps < 5000);
  }
}
