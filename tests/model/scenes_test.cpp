// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "model_support.hpp"

using namespace eomgen::model;

TEST_CASE("a file without scenes has a default one") {
  const Model model = read(particle(""));
  REQUIRE(model.scenes.size() == 1);
  CHECK(model.scenes[0].name == "default");
  CHECK(exact(model, model.scenes[0].t1) == 10);
  CHECK(model.scenes[0].solver == "auto");
  CHECK(model.scenes[0].rtol == no_node);
}

TEST_CASE("a scene contains times, initial values, adjustable values, settings and outputs") {
  const Model model = read(particle(R"toml(
[inputs]
F = { unit = "N", default = 0 }
G = { unit = "N" }
[[force]]
on = "P"
force = "(F + G)*E1"
[definitions]
h = "dot(P, E3)"
[[constraint]]
name = "rod"
holonomic = ["R - L", "theta"]
[scene.default]
t = ["0 s", "2 min"]
initial = { phi = "30 deg", theta = 1, phi_dot = "2*phi/1[s]", R = "L*cos(theta)" }
solve = ["theta_dot"]
guess = { theta_dot = 0.5 }
parameters = { L = "2 m" }
inputs = { F = "3[N]*sin(t/1[s])", G = { t = [0, 1], value = ["1 N", 2] } }
outputs = ["energy", "kinetic", "power", "all", "h", "phi", "phi_dot", "P.position1", "P.velocity3", "reaction.rod", "reaction.rod.2"]
solver = "dop853"
rtol = 1e-9
atol = "1e-12"
step = "1 ms"
every = 0.01
)toml"));
  const Scene& scene = model.scenes[0];
  CHECK(exact(model, scene.t1) == 120);
  REQUIRE(scene.initial.size() == 4);
  CHECK(scene.initial[2].order == 1);
  CHECK(model.coordinates[scene.initial[0].coordinate].name == "phi");
  CHECK(scene.solve[0].second == 1);
  CHECK(scene.guess.size() == 1);
  CHECK(exact(model, scene.parameters[0].second) == 2);
  CHECK(std::get<InputTable>(scene.inputs[1].signal).t.size() == 2);
  CHECK(scene.outputs.size() == 11);
  CHECK(scene.solver == "dop853");
  CHECK(exact(model, scene.rtol) == ratio(1, 1000000000));
  CHECK(exact(model, scene.step) == ratio(1, 1000));
}

TEST_CASE("a scene inherits from another: tables merge, other keys replace") {
  const Model model = read(particle(R"toml(
[scene.b]
from = "default"
initial = { phi = 2, theta_dot = 3 }
outputs = ["kinetic"]
[scene.c]
from = "b"
t = [0, 1]
[scene.default]
t = [0, 5]
initial = { R = 1, phi = 1 }
outputs = ["energy", "potential"]
rtol = 1e-8
)toml"));
  REQUIRE(model.scenes.size() == 3);
  CHECK(model.scenes[0].name == "default");
  const Scene& c = model.scene("c");
  CHECK(exact(model, c.t1) == 1);
  REQUIRE(c.initial.size() == 3);
  CHECK(exact(model, c.initial[1].value) == 2);
  CHECK(c.outputs.size() == 1);
  CHECK(exact(model, c.rtol) == ratio(1, 100000000));
  CHECK(exact(model, model.scene("b").t1) == 5);
}

TEST_CASE("the error for an unknown scene suggests a similar name") {
  const Model model = read(particle("[scene.default]\n[scene.fast]\nfrom = \"default\"\n"));
  try {
    model.scene("fsat");
    FAIL("accepted");
  } catch (const eomgen::Error& error) {
    CHECK(error.message() == "there is no scene 'fsat'");
    CHECK(error.remedy() == "did you mean 'fast'?");
    CHECK(error.exit_code() == 2);
  }
}

TEST_CASE("initial values may use functions at the start and definitions of known values") {
  CHECK(refusal(particle("[functions]\nd = \"L + t*1[m/s]\"\n[definitions]\ns = \"R*sin(phi)\"\n[scene.default]\n"
                         "initial = { R = \"d\", R_dot = \"d_dot\", phi = 1, theta_dot = \"s/L/1[s]\" }\n")) ==
        "accepted");
  CHECK(refusal(particle(
            "[definitions]\ns = \"ddt(R)*1[s]\"\n[scene.default]\ninitial = { R = 1, phi = 1, theta = \"s/L\" }\n")) ==
        "the start value of 'theta' uses 'R_dot', which is not given before it");
}

TEST_CASE("an output requested twice is listed once") {
  const Model model = read(particle("[scene.default]\noutputs = [\"kinetic\", \"kinetic\"]\n"));
  CHECK(model.scenes[0].outputs.size() == 1);
  CHECK(model.warnings.front().message == "the output 'kinetic' is requested twice");
}

TEST_CASE("scenes that inherit an input warn of its unit once") {
  const auto warnings = [](const std::string& more) {
    return read(particle("[inputs]\nF = { unit = \"N\", default = 0 }\n[[force]]\non = \"P\"\nforce = \"F*E1\"\n"
                         "[scene.default]\ninputs = { F = \"3*sin(2[1/s]*t)\" }\n" +
                         more))
        .warnings;
  };
  const std::vector<eomgen::Warning> once = warnings("");
  CHECK(std::count_if(once.begin(), once.end(), [](const eomgen::Warning& w) {
          return w.message == "the input 'F' must be in N, and this is in 1";
        }) == 1);
  CHECK(warnings("[scene.second]\nfrom = \"default\"\n[scene.third]\nfrom = \"second\"\n").size() == once.size());
}

TEST_CASE("an angle above a full turn without a unit causes a warning") {
  const auto warned = [](const std::string& value) {
    std::string all;
    for (const eomgen::Warning& warning :
         read(particle("[scene.default]\ninitial = { R = 1, phi = 1, theta = " + value + " }\n")).warnings) {
      if (warning.message.find("starts at") != std::string::npos) all += warning.message + " / " + warning.remedy;
    }
    return all;
  };
  CHECK(warned("45") == "'theta' starts at 45: radians? / write \"45 deg\" for degrees, \"45 rad\" for radians");
  CHECK(warned("-6.5").starts_with("'theta' starts at -6.5: radians?"));
  for (const char* fine : {"6.28", "\"45 deg\"", "\"45 rad\"", "\"20*pi\""})
    CHECK_FALSE(warned(fine).find("radians?") != std::string::npos);
  CHECK(read(particle("[scene.default]\ninitial = { R = 45, phi = 1, theta_dot = 45 }\n")).warnings.size() ==
        read(particle("[scene.default]\ninitial = { R = 1, phi = 1, theta_dot = 4 }\n")).warnings.size());
}

TEST_CASE("scenes: outputs may be conserved quantities, of which the derivation knows the names") {
  const auto with_output = [](const std::string& name) {
    return read(particle("[scene.default]\noutputs = [\"" + name + "\"]\n")).scenes[0].outputs.size();
  };
  for (const char* name : {"momentum.theta", "jacobi", "energy.applied", "linear_momentum.E1", "angular_momentum.E3"})
    CHECK_MESSAGE(with_output(name) == 1, name);
  for (const char* name : {"momentum.nothing", "momentum.m", "momentum", "integral.theta", "energy.kinetic"})
    CHECK_THROWS_WITH_AS(with_output(name), doctest::Contains("there is no output"), eomgen::Error);
}
