// SPDX-License-Identifier: GPL-3.0-or-later
// Models whose constraints determine the motion: those with coordinates left to integrate run, the others are rejected.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/inverse.hpp"
#include "analysis/steady.hpp"
#include "support/folders.hpp"
#include "support/run_text.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

std::string written(const std::string& text) {
  const std::string path = test::build_folder() + "/freedom.toml";
  test::write_text(path, text);
  return path;
}

std::string planar(const std::string& second) {
  return "format = 1\n[parameters]\nm = 1\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", "
         "\"y\"] }\n"
         "[[constraint]]\nname = \"a\"\nholonomic = \"x^2 + y^2 - 4\"\n"
         "[[constraint]]\nname = \"b\"\nholonomic = \"" +
         second + "\"\n[scene.default]\ninitial = { x = 1.2, y = 1.6 }\n";
}

const char* const rolling_wheel = R"toml(format = 1
[parameters]
m = { value = 1, positive = true }
R = { value = 0.5, positive = true }
I = { value = 0.2, positive = true }
[functions]
s = "0.3*sin(t)"
[coordinates]
x = {}
phi = {}
[energy]
kinetic = "m*x_dot^2/2 + I*phi_dot^2/2"
[[constraint]]
name = "roll"
velocity = "x_dot - R*phi_dot"
[[constraint]]
name = "path"
holonomic = "x - s"
)toml";

// A rod of length l between a crank pin at radius r and a piston on the axis E1; the crank turns at 2 rad/s.
const char* const slider_crank = R"toml(format = 1
[parameters]
m1 = { value = 1, positive = true }
m2 = { value = 2, positive = true }
r = { value = 0.3, positive = true }
l = { value = 1, positive = true }
[functions]
drive = "2*t"
[coordinates]
th = {}
be = {}
x = {}
[[body]]
name = "rod"
mass = "m1"
inertia = "m1*l^2/12"
position = ["r*cos(th) + l/2*cos(be)", "r*sin(th) + l/2*sin(be)", 0]
rotation = { axis = "E3", angle = "be" }
[[particle]]
name = "piston"
mass = "m2"
position = ["x", 0, 0]
[[constraint]]
name = "crank"
holonomic = "th - drive"
[[constraint]]
name = "pinx"
holonomic = "r*cos(th) + l*cos(be) - x"
[[constraint]]
name = "piny"
holonomic = "r*sin(th) + l*sin(be)"
[scene.default]
t = [0, 3]
guess = { be = 0, x = 1.3 }
)toml";

// A body whose angular velocity is a given function of time, along its own axes.
std::string attitude(const std::string& rotation, const std::string& start) {
  return R"toml(format = 1
[functions]
w1 = "0.3*sin(t)"
w2 = "0.2 + 0.1*cos(2*t)"
w3 = "0.5*t"
[[body]]
name = "B"
mass = 1
inertia = { principal = [1, 2, 2.5] }
position = [0, 0, 0]
rotation = )toml" +
         rotation + R"toml(
[[constraint]]
name = "one"
velocity = "dot(B.omega, B.e1) - w1"
[[constraint]]
name = "two"
velocity = "dot(B.omega, B.e2) - w2"
[[constraint]]
name = "three"
velocity = "dot(B.omega, B.e3) - w3"
[scene.default]
t = [0, 2]
initial = )toml" +
         start +
         "\noutputs = [\"B.omega1\", \"B.omega2\", \"B.omega3\", \"e11\", \"e12\", \"e33\"]\n[definitions]\n"
         "e11 = \"dot(B.e1, E1)\"\ne12 = \"dot(B.e1, E2)\"\ne33 = \"dot(B.e3, E3)\"\n";
}

template <class F>
void check_refused(const char* message, F&& call) {
  try {
    call();
    FAIL("accepted");
  } catch (const Error& error) {
    CHECK(error.message() == message);
    CHECK(error.where().line >= 11);  // the last constraint
    CHECK(error.exit_code() == 2);
  }
}

}  // namespace

TEST_CASE("freedom: constraints that hold a particle together are solved along with its motion") {
  const test::FinishedRun run = test::run_model(written(planar("x*y - 1.92")));
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.final("x") == doctest::Approx(1.2).epsilon(1e-12));
  CHECK(run.final("y") == doctest::Approx(1.6).epsilon(1e-12));
}

TEST_CASE("freedom: coordinates that are all prescribed leave nothing to integrate") {
  std::string text = planar("y - 1.6");
  text.replace(text.find("x^2 + y^2 - 4"), 13, "x - 1.2");
  const auto model = test::model_at(written(text));
  check_refused("the constraints fix every coordinate: nothing is left to integrate",
                [&] { pipeline::derive_model(model, pipeline::ApproachChoice::automatic); });
}

TEST_CASE("freedom: a wheel that rolls along a prescribed path turns, and needs the force of its whole inertia") {
  const std::string path = written(rolling_wheel);
  const test::FinishedRun run = test::run_model(path);
  CHECK(run.final("phi") == doctest::Approx(0.6 * std::sin(10.0)).epsilon(1e-9));
  CHECK(run.final("phi_dot") == doctest::Approx(0.6 * std::cos(10.0)).epsilon(1e-9));
  analysis::InverseRequest request;
  request.model = test::model_at(path);
  std::vector<std::string> columns;
  int rows = 0;
  request.begin = [&](const run::Scene&, const std::vector<std::string>& names) { columns = names; };
  request.row = [&](double t, std::span<const double> row) {
    const auto found = std::find(columns.begin(), columns.end(), "force.x");
    REQUIRE(found != columns.end());
    // (m + I/R^2) x_ddot
    CHECK(row[static_cast<std::size_t>(found - columns.begin())] ==
          doctest::Approx(-1.8 * 0.3 * std::sin(t)).epsilon(1e-8));
    ++rows;
  };
  CHECK(analysis::inverse_dynamics(request).outcome == eom::Outcome::done);
  CHECK(rows > 100);
  check_refused("the constraints determine the motion: no other motion is near it", [&] {
    analysis::steady_problem("linearize", test::model_at(path), "default", {}, {}, 1, analysis::Contacts::none);
  });
}

TEST_CASE("freedom: friction along a prescribed path counts in the force that the path needs") {
  // A block of 1 kg on a rough floor moves as s(t) along x.
  const auto force = [](const std::string& motion, const std::string& law, const auto& check) {
    const std::string path = written("format = 1\n[functions]\ns = \"" + motion + R"toml("
[[particle]]
name = "B"
mass = 1
position = { cartesian = ["x", "z"] }
[[force]]
gravity = "-9.81*E2"
[[constraint]]
name = "floor"
holonomic = "z"
friction = { dynamic = 0.3, )toml" + law +
                                     R"toml( }
[[constraint]]
name = "path"
holonomic = "x - s"
[scene.default]
t = [0, 10]
)toml");
    analysis::InverseRequest request;
    request.model = test::model_at(path);
    std::size_t column = 0;
    request.begin = [&](const run::Scene&, const std::vector<std::string>& names) {
      column = static_cast<std::size_t>(std::find(names.begin(), names.end(), "force.x") - names.begin());
      REQUIRE(column < names.size());
    };
    request.row = [&](double t, std::span<const double> row) {
      CHECK(row[column] == doctest::Approx(check(t)).epsilon(1e-9));
    };
    return analysis::inverse_dynamics(request);
  };
  const double weight = 0.3 * 9.81;
  const auto turning = [&](double t) { return std::sin(t) * -0.3 + std::copysign(weight, std::cos(t)); };
  CHECK(force("0.3*sin(t)", "static = 0.4", turning).detail.empty());
  const auto starting = [&](double t) { return 0.3 * std::cos(t) + std::copysign(weight, std::sin(t)); };
  CHECK(force("0.3*(1 - cos(t))", "static = 0.4", starting).detail.empty());
  const auto smooth = [&](double t) {
    const double slip = 0.3 * std::cos(t);
    return std::sin(t) * -0.3 + weight * slip / std::hypot(slip, 0.01);
  };
  CHECK(force("0.3*sin(t)", "law = \"smooth\", width = 0.01", smooth).outcome == eom::Outcome::done);
  const auto waiting = [&](double t) { return t <= 2 ? 0 : 0.6 + weight; };
  const analysis::InverseDynamicsResult rest = force("0.3*max(0, t - 2)^2", "static = 0.4", waiting);
  CHECK(rest.outcome == eom::Outcome::done);
  CHECK(rest.detail.find("'floor' is at rest at t = 0") != std::string::npos);
}

TEST_CASE("freedom: a driven slider-crank moves as its geometry demands, with forces whose power is that of energy") {
  const test::FinishedRun run = test::run_model(written(slider_crank));
  REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.result.power_balance < 1e-7);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double th = 2 * run.rows.t[i], be = -std::asin(0.3 * std::sin(th));
    REQUIRE(run.rows.at(i, "be") == doctest::Approx(be).epsilon(1e-8));
    REQUIRE(run.rows.at(i, "x") == doctest::Approx(0.3 * std::cos(th) + std::cos(be)).epsilon(1e-8));
  }
}

TEST_CASE("freedom: the attitude follows from a given angular velocity, in angles as in Euler parameters") {
  const test::FinishedRun angles = test::run_model(
      written(attitude("{ euler = \"313\", angles = [\"psi\", \"theta\", \"phi\"] }", "{ theta = 1 }")));
  const test::FinishedRun parameters = test::run_model(written(
      attitude("{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }", "{ e0 = \"cos(1/2)\", e1 = \"sin(1/2)\" }")));
  for (const test::FinishedRun* run : {&angles, &parameters}) {
    REQUIRE(run->simulation.result.outcome == eom::Outcome::done);
    CHECK(run->final("B.omega1") == doctest::Approx(0.3 * std::sin(2.0)).epsilon(1e-9));
    CHECK(run->final("B.omega2") == doctest::Approx(0.2 + 0.1 * std::cos(4.0)).epsilon(1e-9));
    CHECK(run->final("B.omega3") == doctest::Approx(1).epsilon(1e-9));
  }
  for (const char* cosine : {"e11", "e12", "e33", "reaction.one", "reaction.three"})
    CHECK(angles.final(cosine) == doctest::Approx(parameters.final(cosine)).epsilon(1e-8));
}

TEST_CASE("freedom: energies below what the tolerances of the states resolve are no open balance") {
  // The start satisfies the constraint to 2e-16, and so the energy of 0 there is one of 2e-15.
  for (const char* x : {"-1.2", "-2"}) {
    CAPTURE(std::string(x));
    const test::FinishedRun run = test::run_text(
        "steep", std::string("[coordinates]\nx = {}\nz = {}\n[[particle]]\nname = \"P\"\nmass = 1\nposition = "
                             "[\"x\", 0, \"z\"]\n[[force]]\ngravity = \"-9.81*E3\"\n[[constraint]]\nname = "
                             "\"c\"\nholonomic = \"z - exp(30*x)\"\n[scene.default]\nt = [0, 1]\ninitial = { x = ") +
                     x + " }\n");
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
  }
}
