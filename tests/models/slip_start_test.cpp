// SPDX-License-Identifier: GPL-3.0-or-later
// The start and the end of slip of several contacts together, and of slip in two directions, whose direction changes at
// a rate without bound there: against closed forms, and against equations of motion that are solved elsewhere.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "models/contact_runs.hpp"
#include "support/run_text.hpp"

namespace eomgen {
namespace {

using test::at_tolerance;
using test::events_of;
using test::FinishedRun;

constexpr double weight_of_kg = 9.81;

std::size_t number_of(const FinishedRun& run, const std::string& kind) {
  std::size_t count = 0;
  for (const eom::hybrid::Event& event : events_of(run)) count += event.kind == kind ? 1 : 0;
  return count;
}

std::function<void(pipeline::SimulationRequest&)> with_solver(const std::string& solver, double rtol) {
  return [solver, rtol](pipeline::SimulationRequest& request) {
    at_tolerance(rtol)(request);
    request.overrides.solver = solver;
  };
}

constexpr const char* puck = R"toml(
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", "y", "z"] }

[[constraint]]
name = "floor"
holonomic = "dot(P, E3)"
friction = { static = 0.3, dynamic = 0.3 }
holds = "unilateral"

[[force]]
gravity = "-9.81*E3"

[[force]]
on = "P"
force = "3*t*E1 + sin(5*t)*E2"

[scene.default]
t = [0, 2]
initial = { x = 0.2, y = 0, z = 0 }
)toml";

/// A box of 3 kg on legs, pushed by 10 t along E1, turned by 0.3 t about the vertical.
std::string table(const std::string& legs) {
  return R"toml(
[[body]]
name = "B"
mass = 3
inertia = { box = [0.3, 0.2, 0.1] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler = "321", angles = ["p", "q", "r"] }

[[contact]]
name = "f"
body = "B"
points = { )toml" +
         legs + R"toml( }
on = "ground"
friction = { static = 0.5, dynamic = 0.5 }

[[force]]
gravity = "-9.81*E3"

[[force]]
on = "B"
force = "10*t*E1"

[[force]]
on = "B"
moment = "0.3*t*E3"

[scene.default]
t = [0, 2]
initial = { x = 0, y = 0, z = 0.05, p = 0, q = 0, r = 0 }
)toml";
}

}  // namespace

// Slip begins where the force is mu m g. The place at the end: v' = F(t) - mu g v/|v| by the Radau method of SciPy
// at rtol 1e-11, with the slip of 1e-13 along the force at the start.
TEST_CASE("slip start: a puck that a turning force pulls slips once, with every solver") {
  double early = 0.5, late = 1;
  for (int k = 0; k < 60; ++k) {
    const double middle = (early + late) / 2;
    (std::hypot(3 * middle, std::sin(5 * middle)) > 0.3 * weight_of_kg ? late : early) = middle;
  }
  for (const std::string solver : {"auto", "dopri5", "tsit5", "dop853", "radau", "radau5"}) {
    for (const double rtol : {1e-6, 1e-9}) {
      CAPTURE(solver);
      CAPTURE(rtol);
      const FinishedRun run = test::run_text("puck", puck, with_solver(solver, rtol));
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      REQUIRE(events_of(run).size() == 1);
      CHECK(events_of(run)[0].kind == "slip");
      CHECK(std::abs(events_of(run)[0].t - early) < 1e-9);
      // Slip has no direction up to 30 tolerances; the places of the reference are known to 1e-8.
      CHECK(std::abs(run.final("x") - 0.75831289) < 1e-8 + 100 * rtol);
      CHECK(std::abs(run.final("y") - 0.07036144) < 1e-8 + 100 * rtol);
      CHECK(run.simulation.result.statistics.steps < 20000);  // explicit ones; a million if the direction is not led
    }
  }
}

// It rests until M = mu R m g/(cos al (1 + mu^2)), R = 0.1, m = 2, then turns with M - that moment about its own axis.
TEST_CASE("slip start: a cylinder in a rough groove slips at both sides at the same time") {
  const std::string groove = R"toml(
[[body]]
name = "C"
mass = 2
inertia = 0.01
position = { cartesian = ["x", "0", "z"] }
rotation = { axis = "E2", angle = "th" }

[[constraint]]
name = "left"
rolling = { body = "C", shape = { sphere = 0.1 }, on = { point = "origin", normal = "sin(0.7)*E1 + cos(0.7)*E3" } }
friction = { static = 0.3, dynamic = 0.3 }
holds = "unilateral"

[[constraint]]
name = "right"
rolling = { body = "C", shape = { sphere = 0.1 }, on = { point = "origin", normal = "-sin(0.7)*E1 + cos(0.7)*E3" } }
friction = { static = 0.3, dynamic = 0.3 }
holds = "unilateral"

[[force]]
gravity = "-9.81*E3"

[[force]]
on = "C"
moment = "t*E2"

[scene.default]
t = [0, 3]
initial = { x = 0, z = "0.1/cos(0.7)", th = 0 }
)toml";
  const double slip = 0.3 * 0.1 * 2 * weight_of_kg / (std::cos(0.7) * (1 + 0.3 * 0.3));
  const double angle = std::pow(3 - slip, 3) / 6 / 0.01;
  for (const std::string solver : {"auto", "dopri5", "radau5"}) {
    for (const double rtol : {1e-5, 1e-7, 1e-9, 1e-11}) {
      CAPTURE(solver);
      CAPTURE(rtol);
      const FinishedRun run = test::run_text("groove", groove, with_solver(solver, rtol));
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      REQUIRE(events_of(run).size() == 2);
      CHECK(number_of(run, "slip") == 2);
      for (const eom::hybrid::Event& event : events_of(run))
        CHECK(std::abs(event.t - slip) < 1e-8);  // the barrier of undetermined forces
      CHECK(std::abs(run.final("th") / angle - 1) < 1e-8);
    }
  }
}

// Three legs: Newton and Euler's equations by the Radau method of SciPy. Four legs: the largest load with N >= 0 and
// |T| <= mu N by its SLSQP.
TEST_CASE("slip start: a table that turns as it begins to slip") {
  const std::string three =
      "a = \"-0.15*B.e1 - 0.05*B.e3\", b = \"0.15*B.e1 - 0.1*B.e2 - 0.05*B.e3\", "
      "c = \"0.15*B.e1 + 0.1*B.e2 - 0.05*B.e3\"";
  for (const std::string solver : {"auto", "dopri5"}) {
    for (const double rtol : {1e-6, 1e-9, 1e-11}) {
      if (solver == "dopri5" && rtol < 1e-9) continue;  // 140 000 steps
      CAPTURE(solver);
      CAPTURE(rtol);
      const FinishedRun run = test::run_text("table_3", table(three), with_solver(solver, rtol));
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      CHECK(number_of(run, "slip") == 3);
      CHECK(std::abs(events_of(run)[0].t - 1.4423443) < 1e-7);
      CHECK(std::abs(run.final("p") - 0.15070243) < 1e-8 + 100 * rtol);
      // At 1e-11 rounding decides how often the solver changes: 800 to 1700 steps with masses from 2.9999 to 3.0001.
      CHECK(run.simulation.result.statistics.steps < (solver != "auto" ? 40000 : rtol < 1e-9 ? 2500 : 200));
    }
  }
  const std::string four =
      "a = \"-0.15*B.e1 - 0.1*B.e2 - 0.05*B.e3\", b = \"0.15*B.e1 - 0.1*B.e2 - 0.05*B.e3\", "
      "c = \"0.15*B.e1 + 0.1*B.e2 - 0.05*B.e3\", d = \"-0.15*B.e1 + 0.1*B.e2 - 0.05*B.e3\"";
  for (const double rtol : {1e-7, 1e-9, 1e-11}) {
    CAPTURE(rtol);
    const FinishedRun run = test::run_text("table_4", table(four), at_tolerance(rtol));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    REQUIRE(events_of(run).size() == 4);
    CHECK(number_of(run, "slip") == 4);
    for (const eom::hybrid::Event& event : events_of(run)) CHECK(std::abs(event.t - 1.443279) < 1e-6);
  }
}

// Points of one body stop together, and rocking lower than the rounding of the gaps ends. The place x is the one to
// which runs at ever smaller tolerances converge.
TEST_CASE("slip start: a thrown box comes to rest at every tolerance") {
  for (const double rtol : {1e-5, 1e-6, 1e-7, 1e-8, 1e-10}) {
    for (const double atol : {1e-9, 1e-11}) {
      CAPTURE(rtol);
      CAPTURE(atol);
      const FinishedRun run = test::run_model("thrown_box", [&](pipeline::SimulationRequest& request) {
        request.overrides.rtol = rtol;
        request.overrides.atol = atol;
        request.estimate = false;
      });
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      CHECK(run.simulation.result.statistics.steps < 2000);
      CHECK(std::abs(run.final("z") - 0.1) < 1e-9);
      for (const char* rate : {"x_dot", "y_dot", "z_dot"}) CHECK(std::abs(run.final(rate)) < 1e-9);
      CHECK(std::abs(run.final("x") - 0.25914345) < 1e-7 + 100 * rtol);
    }
  }
}

// A box of 0.4 m x 0.2 m rocks on its short side. Sliding that the last impact leaves would tip it again.
TEST_CASE("slip start: a planar box that rocks comes to rest with the laws of impact without friction") {
  const std::string box = R"toml(
[[body]]
name = "B"
mass = 1
inertia = "0.2/12"
position = { cartesian = ["x", "0", "z"] }
rotation = { axis = "E2", angle = "th" }

[[contact]]
name = "k"
body = "B"
points = { a = "-0.2*B.e1 - 0.1*B.e3", b = "0.2*B.e1 - 0.1*B.e3", c = "0.2*B.e1 + 0.1*B.e3", d = "-0.2*B.e1 + 0.1*B.e3" }
on = "ground"
restitution = 0.48
friction = { static = 0.58, dynamic = 0.58 }

[[force]]
gravity = "-9.81*E3"

[scene.default]
t = [0, 3]
initial = { x = 0, z = 0.5, th = 0.03, x_dot = -0.86, th_dot = -4.46 }
)toml";
  for (const double rtol : {1e-6, 1e-9}) {
    CAPTURE(rtol);
    const FinishedRun run = test::run_text("rocking_box", box, at_tolerance(rtol));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(run.simulation.result.statistics.steps < 2000);
    CHECK(std::abs(run.final("z") - 0.2) < 1e-9);
    for (const char* rate : {"x_dot", "z_dot", "th_dot"}) CHECK(std::abs(run.final(rate)) < 1e-9);
  }
}

}  // namespace eomgen
