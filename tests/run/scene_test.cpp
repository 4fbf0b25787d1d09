// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "derive/formulations/lagrange.hpp"
#include "support/particles.hpp"

using namespace eomgen;

namespace {

const std::string rod = R"toml(format = 1
[parameters]
m = 1
g = 9.81
L = 2
)toml" + test::particle_in_plane +
                        R"toml([[constraint]]
name = "rod"
holonomic = "x^2 + y^2 - L^2"
[scene.default]
)toml";

run::Scene resolve(const std::string& text, const run::Overrides& overrides = {}) {
  const model::Model model = model::read_model_text(text, "scene.toml");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const system::EquationSystem system = derive::lagrange(m, system::Approach::two);
  return run::resolve_scene(m, system, model.scene("default"), overrides);
}

std::string refusal(const std::string& text, const run::Overrides& overrides = {}) {
  try {
    resolve(text, overrides);
  } catch (const Error& error) {
    CHECK(error.exit_code() == 2);
    CHECK_FALSE(error.remedy().empty());
    return error.message();
  }
  return "accepted";
}

constexpr double rounding = 1e-14;

}  // namespace

TEST_CASE("scene: positions and rates that are not given follow from the constraints") {
  const run::Scene scene = resolve(rod + "initial = { x = 1.2, x_dot = 0.4 }\nguess = { y = -1 }\n");
  CHECK(scene.q[1] == doctest::Approx(-1.6).epsilon(rounding));
  CHECK(scene.qdot[1] == doctest::Approx(0.3).epsilon(rounding));  // x x_dot + y y_dot = 0
  CHECK(scene.solved_notes.size() == 2);
}

TEST_CASE("scene: the guess selects one of several solutions of the constraints") {
  CHECK(resolve(rod + "initial = { x = 1.2 }\nguess = { y = 3 }\n").q[1] == doctest::Approx(1.6).epsilon(rounding));
  CHECK(resolve(rod + "initial = { x = 1.2 }\nguess = { y = -3 }\n").q[1] == doctest::Approx(-1.6).epsilon(rounding));
}

TEST_CASE(
    "scene: if several choices satisfy the constraints, the unknowns that they depend on most are solved, the others "
    "stay, and this is reported") {
  const std::string guess = "guess = { x = 0.55, y = -1.35 }\n";
  const run::Scene scene = resolve(rod + guess);
  CHECK(scene.q[0] == 0.55);
  CHECK(scene.q[1] == doctest::Approx(-std::sqrt(4 - 0.55 * 0.55)).epsilon(rounding));
  CHECK(std::count(scene.solved_notes.begin(), scene.solved_notes.end(),
                   "x = 0.55 (chosen: the constraints can be met in several ways)") == 1);
  const run::Scene named = resolve(rod + guess + "solve = [\"x\"]\n");
  CHECK(named.q[0] == doctest::Approx(std::sqrt(4 - 1.35 * 1.35)).epsilon(rounding));
  CHECK(named.q[1] == -1.35);
}

TEST_CASE("scene: rates that several constraints determine together are solved, other rates stay 0") {
  const std::string text = R"toml(format = 1
[coordinates]
w = {}
x = {}
y = {}
z = {}
[energy]
kinetic = "w_dot^2 + x_dot^2 + y_dot^2 + z_dot^2"
[[constraint]]
name = "sum"
velocity = "x_dot + y_dot - 3"
[[constraint]]
name = "open"
velocity = "z_dot - w_dot"
[[constraint]]
name = "difference"
velocity = "x_dot - y_dot - 1 - w_dot"
[scene.default]
)toml";
  const run::Scene scene = resolve(text + "initial = { w_dot = 0 }\n");
  CHECK(scene.qdot[1] == doctest::Approx(2).epsilon(rounding));
  CHECK(scene.qdot[2] == doctest::Approx(1).epsilon(rounding));
  CHECK(scene.qdot[3] == 0);
  const run::Scene sliding = resolve(text + "initial = { w_dot = 1 }\n");
  CHECK(sliding.qdot[1] == doctest::Approx(2.5).epsilon(rounding));
  CHECK(sliding.qdot[3] == doctest::Approx(1).epsilon(rounding));
}

namespace {

const std::string ball = R"toml(format = 1
[parameters]
R = 0.3
[[body]]
name = "ball"
mass = 2
inertia = { sphere = "R" }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler = "321", angles = ["psi", "th", "phi"] }
[[constraint]]
name = "roll"
rolling = { body = "ball", at = "-R*E3", on = "ground" }
[scene.default]
)toml";

}  // namespace

TEST_CASE("scene: with a given angular velocity the violated equation is named, with its violation") {
  // x_dot = R w2 holds, y_dot = -R w1 does not.
  const std::string message = refusal(ball + "initial = { x_dot = 0.6, y_dot = 1, \"ball.omega\" = [0.5, 2, 0.1] }\n");
  CHECK(message.find("'roll.2'") != std::string::npos);
  CHECK(message.find("it is off by 1.15 (relative 1,") != std::string::npos);
  const run::Scene scene = resolve(ball + "initial = { x_dot = 0.6, \"ball.omega\" = [0.5, 2, 0.1] }\n");
  CHECK(scene.qdot[1] == doctest::Approx(-0.15).epsilon(rounding));
  // The rates of its angles follow from it, so that naming one in solve would have no effect.
  CHECK(refusal(ball + "initial = { \"ball.omega\" = [0.5, 2, 0.1] }\nsolve = [\"psi_dot\"]\n")
            .find("'psi_dot' in 'solve' follows from 'ball.omega'") != std::string::npos);
}

TEST_CASE("scene: the spin of a rolling body follows from its velocity if only the velocity is given") {
  const run::Scene scene = resolve(ball + "initial = { x_dot = 0.6, y_dot = 0, psi_dot = 0.2, phi_dot = 0 }\n");
  CHECK(scene.qdot[4] == doctest::Approx(2).epsilon(rounding));  // th_dot
}

TEST_CASE("scene: a start on one of two branches reports the other, and the guess that starts there") {
  const auto notes = [](const std::string& scene) { return resolve(rod + scene).solved_notes; };
  const std::vector<std::string> expected{
      "y = 1.6 follows from the constraints",
      "y = -1.6 satisfies them too: the run starts there with guess = { y = -1.6 }"};
  CHECK(notes("initial = { x = 1.2 }\n") == expected);
  const run::Scene below = resolve(rod + "initial = { x = 1.2 }\nguess = { y = -1.6 }\n");
  CHECK(below.q[1] == doctest::Approx(-1.6).epsilon(rounding));
  CHECK(below.solved_notes.size() <= 1);
  CHECK(notes("initial = { x = 2 }\n").size() <= 1);  // both branches are y = 0
  // Two rods of a knee: both unknowns have other values on the other branch.
  const std::string knee =
      "format = 1\n[coordinates]\na = \"rad\"\nb = \"rad\"\n[[particle]]\nname = \"P\"\nmass = 1\n"
      "position = [\"cos(a) + sin(b)\", \"sin(a) - cos(b)\", 0]\n"
      "[[constraint]]\nname = \"x\"\nholonomic = \"cos(a) + sin(b) - 1.2\"\n"
      "[[constraint]]\nname = \"y\"\nholonomic = \"sin(a) - cos(b) - 0.7\"\n[scene.default]\n";
  const std::vector<std::string> both = resolve(knee).solved_notes;
  CHECK(std::any_of(both.begin(), both.end(),
                    [](const std::string& note) { return note.find("satisfy them too") != std::string::npos; }));
  // Full turns, and branches outside a range, are none.
  const std::string turn =
      "format = 1\n[coordinates]\na = \"rad\"\nb = \"rad\"\n[[particle]]\nname = \"P\"\nmass = 1\n"
      "position = [\"cos(a)\", \"sin(a)\", 0]\n[[particle]]\nname = \"Q\"\nmass = 1\n"
      "position = [\"cos(b)\", \"sin(b)\", 0]\n"
      "[[constraint]]\nname = \"gear\"\nholonomic = \"2*a - b\"\n[scene.default]\ninitial = { a = 0.4 }\n";
  CHECK(resolve(turn).solved_notes.size() == 1);
}

TEST_CASE("scene: values that violate a constraint are rejected with the amount, unless solve may change them") {
  const std::string broken = "initial = { x = 1.2, y = -1.7 }\n";
  const std::string message = refusal(rod + broken);
  CHECK(message.find("breaks constraint 'rod'") != std::string::npos);
  CHECK(message.find("0.33") != std::string::npos);  // 1.44 + 2.89 - 4
  const run::Scene scene = resolve(rod + broken + "solve = [\"y\"]\n");
  CHECK(scene.q[0] == 1.2);
  CHECK(scene.q[1] == doctest::Approx(-1.6).epsilon(rounding));
}

TEST_CASE("scene: a start that the constraints do not determine is rejected, not guessed") {
  CHECK(refusal(rod).find("breaks constraint 'rod'") != std::string::npos);
}

TEST_CASE("scene: dependent parameters are computed from the ones that are set") {
  const std::string text = R"toml(format = 1
[parameters]
k = "m*w^2"
m = 2
w = 3
[coordinates]
x = {}
[energy]
kinetic = "m*x_dot^2/2"
potential = "k*x^2/2"
[scene.default]
parameters = { w = 4 }
)toml";
  CHECK(resolve(text).parameters[0] == 32);
  run::Overrides overrides;
  overrides.values["m"] = symbolic::Rational(1) / 2;
  CHECK(resolve(text, overrides).parameters[0] == 8);
  overrides.values["nothing"] = 1;
  CHECK(refusal(text, overrides).find("no parameter 'nothing'") != std::string::npos);
}

TEST_CASE(
    "scene: initial values that are set replace those of the scene, and dependent values are computed from them") {
  const std::string text = rod + "initial = { x = 1.2, x_dot = \"x/3\" }\nguess = { y = -1 }\n";
  run::Overrides overrides;
  overrides.values["x"] = symbolic::Rational(-8) / 5;
  run::Scene scene = resolve(text, overrides);
  CHECK(scene.q[0] == -1.6);
  CHECK(scene.q[1] == doctest::Approx(-1.2).epsilon(rounding));
  CHECK(scene.qdot[0] == doctest::Approx(-1.6 / 3).epsilon(rounding));
  overrides.values["x_dot"] = 3;
  scene = resolve(text, overrides);
  CHECK(scene.qdot[0] == 3);
  CHECK(scene.qdot[1] == doctest::Approx(-4).epsilon(rounding));  // x x_dot + y y_dot = 0
  overrides.values["y"] = 1;                                      // off the circle
  CHECK(refusal(text, overrides).find("breaks constraint 'rod'") != std::string::npos);
  // This is also a start of a scene without initial values.
  run::Overrides alone;
  alone.values["x"] = 2;
  for (const std::string& note : resolve(rod, alone).solved_notes)
    CHECK(note.find("no initial values") == std::string::npos);
}

TEST_CASE("scene: a parameter that is declared positive stays positive") {
  std::string text = rod + "initial = { x = 0, y = -2 }\n";
  text.replace(text.find("L = 2"), 5, "L = { value = 2, positive = true }");
  CHECK(refusal(text) == "accepted");
  run::Overrides overrides;
  overrides.values["L"] = -2;
  CHECK(refusal(text, overrides) == "parameter 'L' is declared positive, and its value is -2");
}

TEST_CASE("scene: parameters and masses beyond the range of binary64 are rejected by name") {
  const std::string text = rod + "initial = { x = 0, y = -2 }\n";
  run::Overrides overrides;
  overrides.values["m"] = symbolic::Rational(1) / cln::expt(cln::cl_RA(10), cln::cl_I(310));
  CHECK(refusal(text, overrides) ==
        "parameter 'm' is about 1e-310 here, which counts as 0: numbers of a run are from 2.2e-308 on");
  overrides.values["m"] = cln::expt(cln::cl_RA(10), cln::cl_I(310));
  CHECK(refusal(text, overrides) ==
        "parameter 'm' is about 1e310 here, which no run can hold: its numbers end at 1.8e308");
  std::string heavy = text;
  heavy.replace(heavy.find("mass = \"m\""), 10, "mass = \"m*1e-200*1e-150\"");
  CHECK(refusal(heavy) ==
        "the mass of 'P' is about 1e-350 here, which counts as 0: numbers of a run are from 2.2e-308 on");
}

TEST_CASE("scene: masses and coefficients of friction that are undefined at its parameters are reported") {
  run::Overrides negative;
  negative.values["k"] = -1;
  std::string text = rod;
  text.replace(text.find("m = 1\n"), 6, "m = 1\nk = 1\n");
  std::string heavy = text;
  heavy.replace(heavy.find("mass = \"m\""), 10, "mass = \"sqrt(k)\"");
  CHECK(refusal(heavy, negative) == "the mass of 'P' has no value here: sqrt of a negative number");
  std::string rough = text;
  rough.replace(rough.find("L^2\"\n"), 5, "L^2\"\nfriction = { static = \"log(k) + 1\", dynamic = \"log(k) + 1\" }\n");
  CHECK(refusal(rough, negative) ==
        "a coefficient of friction of 'rod' has no value here: log of a number that is not positive");
}
