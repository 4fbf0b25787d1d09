// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("P8: theta remains, with (2.150); both constraint forces are those of (2.149)") {
  DisplayedModel p8("P8_smooth_helix");
  const Sum m = p8("m"), g = p8("g"), R = p8("R"), al = p8("alpha"), th = p8("theta"), dth = p8("theta_dot"),
            ddth = p8("theta_ddot");
  for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
    const reading::DisplayForm form = p8.form(approach);
    CHECK(same(p8.motion(form, "theta"), m * (Sum(1) + square(al)) * square(R) * ddth + m * g * al * R));
    CHECK(p8.equation(form, "theta").multipliers.empty());
  }
  // -F.a_r = m g alpha theta and -F.a_nu = m g of the weight, as in (2.145) with its indices put right
  const reading::DisplayForm one = p8.form(system::Approach::one);
  REQUIRE(one.reactions.size() == 2);
  CHECK(one.reactions[0].label == "radius");
  CHECK(same(*one.reactions[0].value, m * square(al) * R * th * ddth - m * R * square(dth) + m * g * al * th));
  CHECK(same(*one.reactions[1].value, m * al * R * ddth + m * g));
}

TEST_CASE("P8: the bead follows (2.151) to 1e-11, and its constraint force is (2.152)") {
  const FinishedRun run = run_model("P8_smooth_helix", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-13;
    request.overrides.atol = 1e-13;
  });
  const double m = run.parameter("m"), g = run.parameter("g"), R = run.parameter("R"), alpha = run.parameter("alpha");
  const double start = 0.5, rate = 4, slope = 1 + alpha * alpha;
  double worst = 0, worst_force = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i];
    const double theta = start + rate * t - g * alpha * t * t / (2 * R * slope),
                 theta_dot = rate - g * alpha * t / (R * slope);
    worst =
        std::max({worst, std::abs(run.rows.at(i, "theta") - theta), std::abs(run.rows.at(i, "theta_dot") - theta_dot)});
    const double radius = m * g * alpha * theta / slope - m * R * theta_dot * theta_dot, height = m * g / slope;
    worst_force = std::max({worst_force, std::abs(run.rows.at(i, "reaction.radius") - radius),
                            std::abs(run.rows.at(i, "reaction.height") - height)});
  }
  CHECK(worst < 1e-11);
  CHECK(worst_force < 1e-10);  // some 10 N
  CHECK(run.drift("energy") < 1e-11);
}
