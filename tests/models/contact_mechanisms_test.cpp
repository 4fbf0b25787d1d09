// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms with contacts against references that share no code with eomgen. Numbers called "computed apart" are from
// a program of its own: a floating base with constraints, impacts by trying all contact states, DOP853 at 1e-13.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "models/contact_runs.hpp"

using namespace eomgen;
using namespace eomgen::test;

// Tolerances: the start has 16 digits, and the motion is 0.23 s long.
TEST_CASE("compass_feet: the strike of a rough foot is that of the gait, at all tolerances") {
  for (const double rtol : all_tolerances) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("compass_feet", "default", at_tolerance(rtol));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    const std::vector<run::RunEvent> events = events_of(run);
    REQUIRE(events.size() == 2);
    const double follows = std::max(1e3 * rtol, 1e-11);  // short and smooth: few steps
    CHECK(events[0].kind == "contact");
    CHECK(events[0].name == "right_foot");
    CHECK(std::abs(events[0].t - 0.2347209621553616) < follows);
    CHECK(std::abs(events[0].work + 5.492517375156236) < 10 * follows);  // computed apart
    CHECK(events[1].kind == "lose_contact");
    CHECK(events[1].name == "left_foot");
    CHECK(run.simulation.result.contact_residual < 1e-14);  // of the impulses, in the last digits
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      if (run.rows.t[i] <= events[0].t) continue;
      // The foot stands where it struck. Rows between steps have the errors of the dense output.
      const double L = run.parameter("a") + run.parameter("b");
      CHECK(std::abs(run.rows.at(i, "x_dot") + L * std::cos(run.rows.at(i, "right")) * run.rows.at(i, "right_dot")) <
            std::max(1e-4 * rtol, rounding));
      CHECK(run.rows.at(i, "reaction.left_foot") == 0);
      CHECK(run.rows.at(i, "reaction.right_foot") > 0);
    }
  }
}

// Times and works computed apart. The slider stays parallel to its guide: its two corners on a side hit together.
// Both corners of the slider meet the guide at the same time, but for the errors of the run. One after the other would
// take 100 impacts more.
TEST_CASE("slider_crank: corners that meet within the errors of the run meet together") {
  const FinishedRun expected = run_rough("slider_crank", "default", at_tolerance(1e-10));
  for (const double rtol : {1e-6, 1e-7, 1e-9}) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("slider_crank", "default", at_tolerance(rtol));
    CHECK(run.simulation.result.events.size() == expected.simulation.result.events.size());
  }
}

TEST_CASE("slider_crank: flights, impacts and slides are those computed apart, and the same at all tolerances") {
  struct Expected {
    const char *kind, *name;
    double t, work;
  };
  const std::array<Expected, 11> expected{{{"contact", "top_rear", 0.00269250275201979, -0.0374102437165},
                                           {"contact", "top_rear", 0.00561236319021561, -0.00591377343817},
                                           {"contact", "top_rear", 0.00747505621242305, -0.00150939619737},
                                           {"contact", "top_rear", 0.00842176793428947, -0.000497678565},
                                           {"lose_contact", "top_rear", 0.0150286517484594, 0},
                                           {"contact", "bottom_rear", 0.0258895628758058, -0.0251835},
                                           {"contact", "bottom_rear", 0.0286606448897146, -0.00652855},
                                           {"reverse", "bottom_rear", 0.034133773949153, 0},
                                           {"lose_contact", "bottom_rear", 0.0343379105892792, 0},
                                           {"contact", "top_rear", 0.039807315555845, -0.0438664},
                                           {"contact", "top_rear", 0.0438940179135698, -0.00728625}}};
  std::vector<run::RunEvent> first;
  for (const double rtol : all_tolerances) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("slider_crank", "default", at_tolerance(rtol));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    // Energies exchanged are 0.01 of that of the crank, and the bounces are cut at 1e-9 of it.
    CHECK(run.simulation.result.power_balance < std::max(10 * rtol, 1e-9));
    const std::vector<run::RunEvent> events = events_of(run);
    auto place = events.begin();
    for (const Expected& wanted : expected) {
      CAPTURE(wanted.t);
      place = std::find_if(place, events.end(), [&](const run::RunEvent& event) {
        return event.kind == wanted.kind && event.name == wanted.name;
      });
      // Bounces that accumulate are left out of the list.
      while (place != events.end() && place->t < wanted.t - 1e-4) {
        place = std::find_if(place + 1, events.end(), [&](const run::RunEvent& event) {
          return event.kind == wanted.kind && event.name == wanted.name;
        });
      }
      REQUIRE(place != events.end());
      // 1e-7 s at rtol 1e-6: the flights are long beside the height of the bounces before them.
      CHECK(std::abs(place->t - wanted.t) < std::max(rtol, 1e-9));
      CHECK(std::abs(place->work - wanted.work) < std::max(rtol, 1e-7));  // six digits of them are given
    }
    if (first.empty()) first = events;
    REQUIRE(events.size() == first.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      CHECK(events[i].kind == first[i].kind);
      CHECK(std::abs(events[i].t - first[i].t) < 1e-6);
      // Both corners change at the same time, in either order.
      const std::string side = events[i].name.substr(0, events[i].name.find('_'));
      CHECK(side == first[i].name.substr(0, first[i].name.find('_')));
    }
  }
}

// Computed apart: seven coordinates, of the trunk and of the angles.
TEST_CASE("quadruped: it slips, sticks and rises as computed apart, and its feet only push") {
  struct Expected {
    const char *kind, *name;
    double t;
  };
  const std::array<Expected, 4> expected{{{"stick", "fore_foot", 0.0023687438325695},
                                          {"stick", "hind_foot", 0.0028245581293963},
                                          {"slip", "fore_foot", 0.631320902379069},
                                          {"stick", "fore_foot", 0.699931827672692}}};
  for (const double rtol : all_tolerances) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("quadruped", "default", at_tolerance(rtol));
    const double follows = std::max(10 * rtol, 1e-9);  // control damps errors; ten digits were computed
    const std::vector<run::RunEvent> events = events_of(run);
    REQUIRE(events.size() == 6);
    for (std::size_t k = 0; k < 2; ++k) CHECK(events[k].t == 0);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      CHECK(events[k + 2].kind == expected[k].kind);
      CHECK(events[k + 2].name == expected[k].name);
      CHECK(std::abs(events[k + 2].t - expected[k].t) < follows);
    }
    for (std::size_t i = 0; i < run.rows.size(); ++i)
      for (const char* foot : {"reaction.fore_foot", "reaction.hind_foot"}) CHECK(run.rows.at(i, foot) > 0);
    CHECK(std::abs(run.final("x") + 7.302721450605e-03) < follows);
    CHECK(std::abs(run.final("z") - 3.489978422998e-01) < follows);
    CHECK(std::abs(run.final("pitch") + 2.110630165308e-03) < follows);
    CHECK(std::abs(run.final("thigh1") - 4.961975459046e-01) < follows);
    CHECK(std::abs(run.final("shank2") + 5.330131289091e-01) < follows);
    CHECK(run.final("reaction.fore_foot") + run.final("reaction.hind_foot") ==
          doctest::Approx(8.6 * run.parameter("g")).epsilon(1e-3));  // almost at rest
    CHECK(run.simulation.result.power_balance < std::max(rtol, 1e-12));
  }
}
