// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE(
    "bouncing_ball: flight times decrease with e^k, the bounces accumulate, and end in sliding that friction stops") {
  const FinishedRun run = run_rough("bouncing_ball");
  const double g = run.parameter("g"), e = run.parameter("e"), mu = run.parameter("mu_d"), first = std::sqrt(2 / g);
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() > 15);
  double t = first, flight = 2 * e * first;
  for (std::size_t i = 0; i + 2 < events.size(); ++i) {
    CHECK(events[i].kind == "contact");
    CHECK(std::abs(events[i].t - t) < integration_tolerance);
    t += flight;
    flight *= e;
  }
  const double zeno = first * (1 + e) / (1 - e), stops = zeno + 3 / (mu * g);
  CHECK(std::abs(events[events.size() - 2].t - zeno) < 1e-7);  // bounces are ended at 1e-7 of the first flight
  CHECK(events.back().kind == "stick");
  CHECK(std::abs(events.back().t - stops) < 1e-7);
  CHECK(std::abs(run.final("x") - (3 * zeno + 9 / (2 * mu * g))) < 1e-7);
  // Impacts take all of m g h, friction all of m 9/2.
  CHECK(run.simulation.result.contact_work == doctest::Approx(-run.parameter("m") * g).epsilon(1e-11));
  CHECK(run.final("energy") == doctest::Approx(0).scale(1));
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    if (run.rows.t[i] < zeno - 1e-6)
      CHECK(std::abs(run.rows.at(i, "x") - 3 * run.rows.t[i]) < integration_tolerance);  // impacts are frictionless
    CHECK(run.rows.at(i, "y") > -1e-12);
  }
}

TEST_CASE("bouncing_ball: a plastic impact ends in contact, an elastic one conserves energy") {
  const FinishedRun plastic = run_rough("bouncing_ball", "plastic");
  const double g = plastic.parameter("g"), mu = plastic.parameter("mu_d"), fall = std::sqrt(2 / g);
  REQUIRE(events_of(plastic).size() == 2);
  CHECK(std::abs(events_of(plastic)[0].t - fall) < integration_tolerance);
  CHECK(std::abs(events_of(plastic)[1].t - fall - 3 / (mu * g)) < integration_tolerance);
  CHECK(plastic.simulation.result.power_balance < 1e-9);

  const FinishedRun elastic = run_rough("bouncing_ball", "elastic");
  REQUIRE(events_of(elastic).size() == 6);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(std::abs(events_of(elastic)[i].t - (2 * static_cast<double>(i) + 1) * fall) < integration_tolerance);
  CHECK(elastic.final("energy") == doctest::Approx(g + 4.5).epsilon(1e-11));
}
