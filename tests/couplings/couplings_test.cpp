// SPDX-License-Identifier: GPL-3.0-or-later
// Gears and belts against closed forms: the ratio of speeds, the multiplier as a moment, Willis' equation.
#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>

#include "couplings/coupling.hpp"
#include "support/run_text.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

FinishedRun run_tight(const std::string& name, const std::string& sections) {
  return run_text(name, sections, [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  });
}

// Runs of a second or two at 1e-12, with motions of the order of 10.
constexpr double same = 1e-9;

std::string shafts(const std::string& gear) {
  return R"toml(
[[body]]
name = "A"
mass = "1 kg"
inertia = "2 kg*m^2"
rotation = { axis = "E3", angle = "a" }
[[body]]
name = "B"
mass = "1 kg"
inertia = "0.5 kg*m^2"
rotation = { axis = "E3", angle = "b" }
[[force]]
moment = "3[N*m]*E3"
on = "A"
[[constraint]]
name = "pair"
gear = { )toml" +
         gear + R"toml( }
[scene.default]
t = [0, 2]
initial = { a = 0.1, b = 0.2, a_dot = 0.5 }
outputs = ["reaction.pair"]
)toml";
}

}  // namespace

TEST_CASE("every coupling has a unique name and equations for bodies and for angles") {
  std::set<std::string> names;
  REQUIRE_FALSE(couplings::registry().empty());
  for (const couplings::Coupling& coupling : couplings::registry()) {
    CAPTURE(coupling.name);
    CHECK(names.insert(coupling.name).second);
    CHECK(couplings::find(coupling.name) == &coupling);
    for (const std::string& text : {coupling.title, coupling.body_equation, coupling.angle_equation})
      CHECK_FALSE(text.empty());
  }
}

TEST_CASE("gear: speeds follow the ratio, the second inertia counts divided by its square, and the reaction is exact") {
  for (const double ratio : {-2.0, 3.0}) {  // gears; a belt
    for (const std::string which :
         {"bodies = [\"A\", \"B\"], axes = \"E3\"", "bodies = [\"A\", \"B\"], axes = [\"2*A.e3\", \"B.e3\"]",
          "angles = [\"a\", \"b\"]"}) {
      CAPTURE(ratio);
      CAPTURE(which);
      const FinishedRun run = run_tight("gear_pair", shafts(which + ", ratio = " + std::to_string(ratio)));
      const double acceleration = 3 / (2 + 0.5 / (ratio * ratio)), t = 2;
      const double turned = 0.5 * t + acceleration * t * t / 2;
      CHECK(std::abs(run.final("a") - (0.1 + turned)) < same);
      CHECK(std::abs(run.final("b") - (0.2 + turned / ratio)) < same);
      CHECK(std::abs(run.final("reaction.pair") - (2 * acceleration - 3)) < same);
      CHECK(run.simulation.derived->mechanics.degrees_of_freedom() == 1);
      CHECK(run.simulation.certificate.pass);
    }
  }
}

TEST_CASE("gear: on a carrier with a fixed ring, Willis' equation holds and the input power is that of the motion") {
  const FinishedRun run = run_tight("gear_planetary", R"toml(
[parameters]
zs = 20
zp = 15
zr = 50
R = "0.1 m"
[[body]]
name = "carrier"
mass = "1 kg"
inertia = "0.2 kg*m^2"
rotation = { axis = "E3", angle = "c" }
[[body]]
name = "sun"
mass = "1 kg"
inertia = "0.1 kg*m^2"
rotation = { axis = "E3", angle = "s" }
[[body]]
name = "planet"
mass = "0.5 kg"
inertia = "0.05 kg*m^2"
position = "R*carrier.e1"
rotation = { axis = "E3", angle = "p" }
[[force]]
rotary_actuator = { bodies = ["ground", "sun"], axis = "E3", moment = "3 N*m" }
[[constraint]]
name = "inner"
gear = { bodies = ["sun", "planet"], axes = "E3", carrier = "carrier", ratio = "-zp/zs" }
[[constraint]]
name = "outer"
gear = { bodies = ["ground", "planet"], axes = "E3", carrier = "carrier", ratio = "zp/zr" }
[scene.default]
t = [0, 1]
initial = { c = 0, s = 0.1, p = 0.2 }
outputs = ["reaction.inner", "reaction.outer", "s_ddot", "p_ddot", "c_ddot"]
)toml");
  const double c = run.final("c_dot");
  CHECK(std::abs(run.final("s_dot") - (1 + 50.0 / 20) * c) < same);
  CHECK(std::abs(run.final("p_dot") - (1 - 50.0 / 15) * c) < same);
  const double sun = 1 + 50.0 / 20, planet = 1 - 50.0 / 15;
  const double inertia = 0.2 + 0.5 * 0.01 + 0.1 * sun * sun + 0.05 * planet * planet;  // of all, on the carrier
  CHECK(std::abs(c - 3 * sun / inertia) < same);
  // Euler's equations: of the sun, of the planet (ratio times the moment on the first), and of the carrier, on which
  // the remainder of both gear moments acts.
  const double inner = run.final("reaction.inner"), outer = run.final("reaction.outer");
  CHECK(std::abs(0.1 * run.final("s_ddot") - 3 - inner) < same);
  CHECK(std::abs(0.05 * run.final("p_ddot") - (15.0 / 20 * inner - 15.0 / 50 * outer)) < same);
  CHECK(std::abs(0.205 * run.final("c_ddot") + (1 + 15.0 / 20) * inner + (1 - 15.0 / 50) * outer) < same);
  CHECK(run.simulation.certificate.pass);
}
