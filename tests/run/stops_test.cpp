// SPDX-License-Identifier: GPL-3.0-or-later
// Friction along a direction that a closed stop constrains, against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

constexpr double closed_form = 1e-9;  // rtol is 1e-9, over a few steps

test::FinishedRun run_text(const std::string& name, const std::string& text) {
  const std::string path = test::build_folder() + "/" + name + ".toml";
  test::write_text(path, text);
  return test::run_model(path, [](pipeline::SimulationRequest& request) { request.overrides.outputs = {"all"}; });
}

/// A block on a rough floor, at the wall x + y = 3, or on a rail there.
std::string block_beside_a_wall(const std::string& floor, const std::string& force, int t_end, bool rail = false) {
  return R"toml(format = 1
[parameters]
m = 2
g = 10
mu = 0.3
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[force]]
gravity = "-g*E3"
[[force]]
on = "P"
force = ")toml" +
         force + R"toml("
[[constraint]]
name = "floor"
holonomic = ")toml" +
         floor + R"toml("
friction = { static = "mu", dynamic = "mu" }
[[constraint]]
name = "wall"
holonomic = "3 - x - y"
)toml" + (rail ? "" : "holds = \"unilateral\"\n") +
         "[scene.default]\ninitial = { x = 1, y = 2 }\nt = [0, " + std::to_string(t_end) + "]\n";
}

/// A slider in a rough guide with at most 4 N of friction, with a stop at x = 1.
std::string slider_with_a_stop(const std::string& forces, const std::string& restitution, const std::string& scene) {
  return R"toml(format = 1
[parameters]
m = 2
F = 4
[coordinates]
x = {}
[energy]
kinetic = "1/2*m*x_dot^2"
potential = "0"
)toml" + forces +
         R"toml([[force]]
name = "guide"
dry = { coordinate = "x", normal = "F", static = 1, dynamic = 1 }
[[constraint]]
name = "stop"
holonomic = "1 - x"
holds = "unilateral"
)toml" + restitution +
         "[scene.default]\n" + scene;
}

}  // namespace

TEST_CASE("stops: a slider on a rough guide bounces off its stop and comes to rest by friction") {
  const test::FinishedRun end = run_text(
      "slider", slider_with_a_stop("", "restitution = 0.3\n", "t = [0, 5]\ninitial = { x = 0.5, x_dot = 2 }\n"));
  // The deceleration is F/m = 2: 4 - 2*2/2 = 2 is the square of its speed at the stop, e^2*2 that after it.
  CHECK(std::abs(end.final("x") - (1 - 0.09 * 2 / (2 * 2))) <= closed_form);
  CHECK(end.final("x_dot") == 0);
  CHECK(end.final("friction.guide") == 0);  // no load
}

TEST_CASE("stops: the stop bears the force that presses a slider onto it; then friction determines the motion") {
  const test::FinishedRun end = run_text(
      "pressed_slider",
      slider_with_a_stop("[[force]]\ngeneralized = { x = \"10 - 6*t\" }\n", "", "t = [0, 4]\ninitial = { x = 1 }\n"));
  const std::size_t last = end.rows.size() - 1;
  bool pressed = false, stuck = false;
  for (std::size_t row = 0; row <= last; ++row) {
    const double t = end.rows.t[row];
    CAPTURE(t);
    if (t < 10.0 / 6 - 1e-6) {  // pressed: the stop bears the whole force
      pressed = true;
      CHECK(std::abs(end.rows.at(row, "reaction.stop") - (10 - 6 * t)) <= closed_form);
      CHECK(std::abs(end.rows.at(row, "friction.guide")) <= closed_form);
    } else if (t > 10.0 / 6 + 1e-6 && t < 14.0 / 6 - 1e-6) {  // pulled by less than the largest friction of the guide
      stuck = true;
      CHECK(end.rows.at(row, "reaction.stop") == 0);
      CHECK(std::abs(end.rows.at(row, "friction.guide") - (6 * t - 10)) <= closed_form);
    }
  }
  CHECK(pressed);
  CHECK(stuck);
  // Then 2 x_ddot = 10 - 6 t + 4 from t = 14/6 on.
  const double s = 4 - 14.0 / 6;
  CHECK(std::abs(end.final("x") - (1 - s * s * s / 2)) <= closed_form);
}

TEST_CASE("stops: a block on a rough floor at a wall or a rail slides along it, and sticks only across it") {
  for (const bool rail : {false, true}) {
    CAPTURE(rail);
    const test::FinishedRun end = run_text(rail ? "block_on_rail" : "block_at_walls",
                                           block_beside_a_wall("z", "50*E1 + 30*E2 + 4*t*(E1 - E2)", 2, rail));
    // Along the wall, (E1 - E2)/sqrt(2), it is pulled by (20 + 8 t)/sqrt(2) > mu m g = 6: it slides from the start.
    const double root = std::sqrt(2.0), along = (10 * 4 + 4.0 * 8 / 3) / root / 2 - 6.0 * 4 / 2 / 2;
    CHECK(std::abs((end.final("x") - end.final("y") + 1) / root - along) <= 1e-8);
    CHECK(std::abs(end.final("x") + end.final("y") - 3) <= closed_form);
    CHECK(std::abs(end.final("reaction.wall") - 40) <= closed_form);  // (50 + 30)/sqrt(2) over |grad psi| = sqrt(2)
  }
}

TEST_CASE("stops: a block that sticks beside a wall or on a rail has no friction towards it") {
  for (const bool rail : {false, true}) {
    CAPTURE(rail);
    const test::FinishedRun end = run_text(rail ? "block_at_rest_on_rail" : "block_at_rest",
                                           block_beside_a_wall("z - x/10", "50*E1 + 46*E2", 1, rail));
    CHECK(std::abs(end.final("x") - 1) <= closed_form);
    CHECK(std::abs(end.final("y") - 2) <= closed_form);
    // The force F, the weight and the normal forces of floor and wall have no component along (1, -1, 1/10), the line
    // of possible motion; the friction f along it balances theirs.
    const double length = std::sqrt(2.01), pull = (50 - 46 - 20 * 0.1) / length;
    const double f[3] = {end.final("friction.floor.1"), end.final("friction.floor.2"), end.final("friction.floor.3")};
    CHECK(std::abs((f[0] - f[1] + f[2] / 10) / length + pull) <= closed_form);
    const double square = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
    CHECK(std::abs(square - pull * pull) <= closed_form);  // and no other component
  }
}

TEST_CASE("stops: a floor and a ceiling each reflect a ball with their own coefficient of restitution") {
  // The forces are not determined if both contacts are closed: a run must not evaluate them there.
  const test::FinishedRun end = run_text("ball_between", R"toml(format = 1
[parameters]
m = 2
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "h"] }
[[constraint]]
name = "guide"
velocity = "(1 + x^2)*x_dot - h_dot"
[[constraint]]
name = "floor"
holonomic = "h"
holds = "unilateral"
restitution = 0.5
[[constraint]]
name = "ceiling"
holonomic = "1 - h"
holds = "unilateral"
restitution = 0.25
[scene.default]
t = [0, 8]
initial = { x = 0, h = 0.5, x_dot = 1 }
)toml");
  // Along h = 1/2 + x + x^3/3 the kinetic energy is constant: m/2 h_dot^2 (1 + 1/(1 + x^2)^2).
  CHECK(std::abs(end.final("x") + std::pow(end.final("x"), 3) / 3 + 0.5 - end.final("h")) <= closed_form);
  CHECK(end.simulation.result.outcome == eom::Outcome::done);
  const double x = end.final("x"), rate = end.final("x_dot");
  const double energy = rate * rate * (1 + (1 + x * x) * (1 + x * x));  // over m/2
  // Ceiling, floor: the speed is a quarter, then half of what it was; the third hit comes after t = 8.
  CHECK(std::abs(energy - 2.0 / 16 / 4) <= closed_form);
}

TEST_CASE("stops: touching balls in a row are hit simultaneously, balls with gaps one after the other") {
  for (const bool gap : {false, true}) {
    CAPTURE(gap);
    const test::FinishedRun end = run_text(gap ? "row_with_gap" : "row", R"toml(format = 1
[coordinates]
x1 = {}
x2 = {}
x3 = {}
[energy]
kinetic = "1/2*x1_dot^2 + 1/2*x2_dot^2 + 1/2*x3_dot^2"
potential = "0"
[[constraint]]
name = "left"
holonomic = "x2 - x1 - 1/10"
holds = "unilateral"
restitution = 1
[[constraint]]
name = "right"
holonomic = "x3 - x2 - 1/10"
holds = "unilateral"
restitution = 1
[scene.default]
t = [0, 1]
initial = { x1 = -1, x2 = 0, x1_dot = 2, x3 = )toml" + std::string(gap ? "0.10001" : "0.1") +
                                                                             " }\n");
    const double after[2][3] = {{-2.0 / 3, 4.0 / 3, 4.0 / 3}, {0, 0, 2}};
    CHECK(std::abs(end.final("x1_dot") - after[gap][0]) <= closed_form);
    CHECK(std::abs(end.final("x2_dot") - after[gap][1]) <= closed_form);
    CHECK(std::abs(end.final("x3_dot") - after[gap][2]) <= closed_form);
  }
}

TEST_CASE("stops: contacts that cannot be closed at the start are open, and this is reported") {
  const char* const wheels = R"toml(format = 1
[parameters]
b = 0.05
[coordinates]
phi1 = {}
phi2 = {}
[energy]
kinetic = "1/2*phi1_dot^2 + phi2_dot^2"
potential = "0"
[[force]]
generalized = { phi1 = "2" }
[[constraint]]
name = "forth"
holonomic = "b - (phi1 - phi2)"
holds = "unilateral"
[[constraint]]
name = "back"
holonomic = "b + phi1 - phi2"
holds = "unilateral"
[scene.default]
t = [0, 1]
)toml";
  const test::FinishedRun end = run_text("backlash", wheels);
  const auto has_note = [&](const std::string& text) {
    const std::vector<std::string>& all = end.simulation.scene.solved_notes;
    return std::any_of(all.begin(), all.end(), [&](const std::string& note) { return note.find(text) != note.npos; });
  };
  CHECK(has_note("'forth', 'back' are open: the start cannot be met while all are closed"));
  // phi1 = t^2 up to b, then both together with 2/3, after the loss of a third of the momentum.
  const double hit = std::sqrt(0.05), rest = 1 - hit;
  CHECK(std::abs(end.final("phi2") - (2 * hit / 3 * rest + rest * rest / 3)) <= closed_form);
  CHECK(std::abs(end.final("phi1") - end.final("phi2") - 0.05) <= closed_form);
}

TEST_CASE("stops: a contact is closed at the start by default, and one that cannot be open is rejected") {
  const std::string ball =
      "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\"] }\n"
      "[[constraint]]\nname = \"floor\"\nholonomic = \"y - x^2 - 1\"\nholds = \"unilateral\"\n";
  const test::FinishedRun end =
      run_text("touching_ball", ball + "[scene.default]\nt = [0, 0.1]\ninitial = { x = 1 }\n");
  CHECK(std::abs(end.rows.at(0, "y") - 2) <= closed_form);
  CHECK_THROWS_WITH_AS(run_text("sunk_ball", ball + "[scene.default]\nt = [0, 0.1]\ninitial = { y = 0.5 }\n"),
                       doctest::Contains("the start breaks constraint 'floor'"), Error);
  CHECK_THROWS_WITH_AS(
      run_text("meeting_ball",
               ball + "[scene.default]\nt = [0, 0.1]\ninitial = { x = 0, y = 1, y_dot = -1, x_dot = 0 }\n"),
      doctest::Contains("the contact approaches at the start"), Error);
}

TEST_CASE("stops: a body that slides on a floor slides on where a coordinate becomes stationary along the floor") {
  // Below the origin the floor's gradient has no component along theta.
  const test::FinishedRun end = run_text("polar_floor", R"toml(format = 1
[parameters]
m = 2
g = 10
mu = 0.1
[coordinates]
r = {}
theta = {}
[[particle]]
name = "P"
mass = "m"
position = "r*sin(theta)*E1 - r*cos(theta)*E2"
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "floor"
holonomic = "r*cos(theta) - 2"
friction = { static = "mu", dynamic = "mu" }
[scene.default]
t = [0, 4]
initial = { theta = -0.5, r_dot = -1.5 }
)toml");
  const double x0 = -2 * std::tan(0.5), v0 = end.rows.at(0, "theta_dot") * 2 / std::pow(std::cos(0.5), 2);
  REQUIRE(v0 > 0);
  REQUIRE(v0 * v0 / 2 > -x0);  // it passes the origin, and comes to rest by the deceleration mu g
  const double x = x0 + v0 * v0 / 2, theta = end.final("theta");
  CHECK(std::abs(2 * std::tan(theta) - x) <= 1e-8);
  CHECK(v0 < 4);  // at rest before the end of the run
}
