// SPDX-License-Identifier: GPL-3.0-or-later
// Which contacts stick, slide and open, where several of them, or friction and a constraint, decide together: against
// equations of equilibrium and of motion that are solved by hand.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "models/contact_runs.hpp"
#include "support/run_text.hpp"

namespace eomgen {
namespace {

using test::at_tolerance;
using test::events_of;
using test::FinishedRun;

constexpr double g = 9.81;

/// A load of 0.3 kg on a rough floor and a rope of 1 m to a mass of 1 kg, which a force F pulls up.
std::string load_on_rope(const std::string& force, const std::string& impacts, const std::string& inputs = "") {
  return R"toml(
[inputs]
F = { default = 16 }

[[particle]]
name = "L"
mass = 0.3
position = { cartesian = ["u", "v"] }

[[particle]]
name = "Q"
mass = 1
position = { cartesian = ["x", "y"] }

[[force]]
gravity = "-9.81*E2"

[[force]]
on = "Q"
force = ")toml" +
         force + R"toml("

[[constraint]]
name = "rope"
holonomic = "1 - norm(L - Q)"

[[constraint]]
name = "floor"
holonomic = "v"
holds = "unilateral"
friction = { static = 0.5, dynamic = 0.5 }
)toml" + impacts +
         R"toml(
[scene.default]
t = [0, 1]
initial = { u = 0.6, v = 0, x = 0, y = 0.8 }
outputs = ["u_ddot", "v_ddot", "reaction.floor"]
)toml" + inputs;
}

const std::string moreau = "[impacts]\nlaw = \"moreau\"\n";

double time_of(const FinishedRun& run, const std::string& kind) {
  for (const run::RunEvent& event : events_of(run))
    if (event.kind == kind) return event.t;
  return std::nan("");
}

std::size_t count_of(const FinishedRun& run, const std::string& kind) {
  std::size_t count = 0;
  for (const run::RunEvent& event : events_of(run)) count += event.kind == kind ? 1 : 0;
  return count;
}

/// A body with two rough surfaces at its ends `foot` and `top`.
std::string ladder(double angle) {
  return R"toml(
[parameters]
L = "4 m"
m = "20 kg"
mu = 0.6

[[body]]
name = "B"
mass = "m"
inertia = "m*L^2/12"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "q" }

[[force]]
gravity = "-9.81[m/s^2]*E2"

[[point]]
name = "foot"
on = "B"
at = [0, "-L/2", 0]

[[point]]
name = "top"
on = "B"
at = [0, "L/2", 0]

[[constraint]]
name = "floor"
holonomic = "dot(foot, E2)"
holds = "unilateral"
friction = { static = "mu", dynamic = "mu" }

[[constraint]]
name = "wall"
holonomic = "dot(top, E1)"
holds = "unilateral"
friction = { static = "mu", dynamic = "mu" }

[scene.default]
t = [0, 1]
outputs = ["reaction.floor", "reaction.wall", "friction.floor", "friction.wall"]
)toml" + ("initial = { q = \"" + std::to_string(angle) + " deg\" }\n");
}

/// A box of 3 kg on two feet on a plane that is inclined by `angle`, pushed along it by F.
std::string box_on_feet(double angle, double mu, double dynamic, const std::string& push) {
  const auto text = [](double value) { return std::to_string(value); };
  return R"toml(
[inputs]
F = {}

[[body]]
name = "B"
mass = 3
inertia = 0.1
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "q" }

[[force]]
gravity = "9.81*()toml" +
         ("sin(" + text(angle) + ")*E1 - cos(" + text(angle) + ")*E2)\"\n") + R"toml(
[[force]]
on = "B"
force = "F*E1"

[[contact]]
name = "c"
body = "B"
points = { l = "-0.2*B.e1 - 0.15*B.e2", r = "0.2*B.e1 - 0.15*B.e2" }
on = { point = "origin", normal = "E2" }
friction = { static = )toml" +
         text(mu) + ", dynamic = " + text(dynamic) + R"toml( }

[scene.default]
t = [0, 2]
initial = { x = 0, y = 0.15, q = 0 }
outputs = ["reaction.c_l", "reaction.c_r", "friction.c_l", "friction.c_r"]
inputs = { F = ")toml" +
         push + "\" }\n";
}

/// The least of N and mu N - |T| of both contacts in all rows.
double least_margin(const FinishedRun& run, double mu, const std::string& first, const std::string& second) {
  double least = 1e300;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    for (const std::string& name : {first, second}) {
      const auto friction = [&](const char* k) { return run.rows.at(i, "friction." + name + k); };
      const double normal = run.rows.at(i, "reaction." + name);
      least = std::min({least, normal, mu * normal - std::hypot(friction(".1"), friction(".2"), friction(".3"))});
    }
  }
  return least;
}

}  // namespace

// Sticking would need tension, and without contact the load would move into the floor: T from
// 0.6 (u_ddot - 0.6 T) + 0.8 (F - g - 0.8 T) = 0, with N = 0.3 g - 0.8 T and u_ddot = (-0.6 T + N/2)/0.3.
TEST_CASE("contact decisions: a load at rest that a rope lifts slides first, and opens once") {
  const double a = 0.5 / 0.3, constant = 0.6 * a * 0.3 * g + 0.8 * (16 - g);
  const double T = constant / (0.6 * (0.6 / 0.3 + a * 0.8 + 0.6) + 0.64), N = 0.3 * g - 0.8 * T;
  const double u_ddot = (-0.6 * T + 0.5 * N) / 0.3;
  REQUIRE(N > 0);
  double lifts = 0;
  for (const std::string& impacts : {std::string(), moreau}) {
    CAPTURE(impacts);
    const FinishedRun run = test::run_text("lifted", load_on_rope("16*E2 - 3*x_dot*E1", impacts), at_tolerance(1e-11));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(run.rows.at(0, "u_ddot") == doctest::Approx(u_ddot).epsilon(1e-12));
    CHECK(std::abs(run.rows.at(0, "v_ddot")) < 1e-12);
    CHECK(run.rows.at(0, "reaction.floor") == doctest::Approx(N).epsilon(1e-12));
    CHECK(count_of(run, "lose_contact") == 1);
    CHECK(count_of(run, "contact") == 0);
    const double now = time_of(run, "lose_contact");
    if (lifts != 0) CHECK(std::abs(now - lifts) < 1e-9);
    lifts = now;
  }
  // The same after a jump of the load at 0.1 s, before which it hangs still (16 N - 6.19 N = g).
  const std::string jump = "inputs = { F = { t = [0, 0.1], value = [9.81, 16] } }\n";
  for (const std::string& impacts : {std::string(), moreau}) {
    CAPTURE(impacts);
    const FinishedRun run =
        test::run_text("lifted_later", load_on_rope("F*E2 - 3*x_dot*E1", impacts, jump), at_tolerance(1e-11));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(std::abs(time_of(run, "slip") - 0.1) < 1e-12);
    CHECK(std::abs(time_of(run, "lose_contact") - 0.1 - lifts) < 1e-9);
    for (std::size_t i = 0; i < run.rows.size(); ++i) CHECK(run.rows.at(i, "reaction.floor") > -1e-9);
  }
}

// 3 t = 0.3 g at t = 0.981; the gap then grows like t^3.
TEST_CASE("contact decisions: a sliding load whose weight is taken off opens once, with every solver") {
  const std::string model = R"toml(
[[particle]]
name = "L"
mass = 0.3
position = { cartesian = ["u", "v"] }

[[force]]
gravity = "-9.81*E2"

[[force]]
on = "L"
force = "(2 + t)*E1 + 3*t*E2"

[[constraint]]
name = "floor"
holonomic = "v"
holds = "unilateral"
friction = { static = 0.5, dynamic = 0.5 }

[scene.default]
t = [0, 2]
initial = { u = 0.3, v = 0 }
)toml";
  for (const std::string solver : {"dop853", "dopri5", "tsit5", "radau5", "rodas", "rk4"}) {
    for (const double rtol : {1e-6, 1e-9, 1e-11}) {
      CAPTURE(solver);
      CAPTURE(rtol);
      const FinishedRun run = test::run_text("weightless", model, [&](pipeline::SimulationRequest& request) {
        at_tolerance(rtol)(request);
        request.overrides.solver = solver;
        if (solver == "rk4") request.overrides.step = 0.002;
      });
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      CHECK(count_of(run, "lose_contact") == 1);
      CHECK(count_of(run, "contact") == 0);
      CHECK(std::abs(time_of(run, "lose_contact") - 0.981) < 1e-9);
    }
  }
}

// Three joints with dry friction at rest under loads: the one set of modes in which no friction drives the motion,
// found by trying all 27 in a program apart. Two joints slide, and the middle one sticks.
TEST_CASE("contact decisions: friction of coupled coordinates at rest never drives the motion") {
  const FinishedRun run = test::run_text("dry_chain", R"toml(
[coordinates]
a = {}
b = {}
c = {}

[[particle]]
name = "A"
mass = 1
position = "sin(a)*E1 - cos(a)*E2"

[[particle]]
name = "B"
mass = 0.7
position = "A + 0.8*(sin(a + b)*E1 - cos(a + b)*E2)"

[[particle]]
name = "C"
mass = 0.5
position = "B + 0.6*(sin(a + b + c)*E1 - cos(a + b + c)*E2)"

[[force]]
gravity = "-9.81*E2"

[[force]]
generalized = { a = 12.8684, b = 10.692, c = 14.7297 }

[[force]]
name = "f1"
dry = { coordinate = "a", normal = 7.2189, static = 1, dynamic = 0.8 }

[[force]]
name = "f2"
dry = { coordinate = "b", normal = 10.8983, static = 1, dynamic = 0.8 }

[[force]]
name = "f3"
dry = { coordinate = "c", normal = 8.3428, static = 1, dynamic = 0.8 }

[scene.default]
t = [0, 0.01]
initial = { a = 0.7, b = -0.9, c = 0.5 }
outputs = ["a_ddot", "b_ddot", "c_ddot", "mode.f1", "mode.f2", "mode.f3"]
)toml");
  CHECK(run.rows.at(0, "mode.f1") == -1);
  CHECK(run.rows.at(0, "mode.f2") == 0);
  CHECK(run.rows.at(0, "mode.f3") == 1);
  CHECK(run.rows.at(0, "a_ddot") == doctest::Approx(-7.34240449746216).epsilon(1e-12));
  CHECK(std::abs(run.rows.at(0, "b_ddot")) < 1e-12);
  CHECK(run.rows.at(0, "c_ddot") == doctest::Approx(67.12596351453539).epsilon(1e-12));
}

// Forces within both cones exist up to the angle 2 atan(mu) from the vertical: 61.9 degrees.
TEST_CASE("contact decisions: a ladder stands as long as any forces within its cones hold it") {
  for (const double angle : {20.0, 25.0, 40.0, 60.0, 61.9}) {
    CAPTURE(angle);
    const FinishedRun run = test::run_text("ladder_at_rest", ladder(angle));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(events_of(run).empty());
    CHECK(std::abs(run.final("q") - angle * std::numbers::pi / 180) < 1e-12);
    CHECK(least_margin(run, 0.6, "floor", "wall") > 0);
  }
  const FinishedRun run = test::run_text("ladder_that_slips", ladder(62.0));
  CHECK(count_of(run, "slip") == 2);
  CHECK(run.final("q") > 62 * std::numbers::pi / 180 + 1e-4);
}

TEST_CASE("contact decisions: a box on two feet rests on an incline, and slips when both feet are at their limits") {
  for (const double angle : {0.1, 0.5, 0.6}) {  // tan 0.6 = 0.684
    CAPTURE(angle);
    const FinishedRun run = test::run_text("box_at_rest", box_on_feet(angle, 0.7, 0.7, "0"));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(events_of(run).empty());
    CHECK(least_margin(run, 0.7, "c_l", "c_r") > 0);
  }
  // 10 t = 0.6 m g; then m x_ddot = 10 t - 0.5 m g.
  const double m = 3, slip = 0.6 * m * g / 10;
  const auto place = [&](double t) { return 10 * t * t * t / (6 * m) - 0.5 * g * t * t / 2; };
  const double speed = 10 * slip * slip / (2 * m) - 0.5 * g * slip;
  const double expected = place(2) - place(slip) - speed * (2 - slip);
  for (const double rtol : {1e-6, 1e-9, 1e-12}) {
    CAPTURE(rtol);
    const FinishedRun run = test::run_text("box_pushed", box_on_feet(0, 0.6, 0.5, "10*t"), at_tolerance(rtol));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    REQUIRE(count_of(run, "slip") == 2);
    CHECK(events_of(run).size() == 2);
    CHECK(std::abs(time_of(run, "slip") - slip) < 1e-8);  // the last weight of the barrier: 1e-9 of the forces
    CHECK(std::abs(run.final("x") - expected) < 1e-8);
  }
}

}  // namespace eomgen
