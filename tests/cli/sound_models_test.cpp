// SPDX-License-Identifier: GPL-3.0-or-later
// Valid models that the certificate of compiled code, or the self test, would refuse if differences were taken relative
// to the wrong magnitude.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "program.hpp"
#include "support/particles.hpp"

using namespace eomgen::test;

namespace {

std::string particle_under(const std::string& parameters, const std::string& force) {
  return fmt::format(R"toml(format = 1
[parameters]
m = 1
{}
[[particle]]
name = "P"
mass = "m"
position = {{ cartesian = ["x", "y"] }}
[[force]]
{}
[scene.default]
t = [0, 10]
initial = {{ x = 0.5, y = 1 }}
)toml",
                     parameters, force);
}

}  // namespace

TEST_CASE("verify: a fully prescribed motion has constraint forces to check") {
  const Folder folder;
  for (const char* model : {"P10_rocket", "R9_robot_arm"}) {
    CAPTURE(model);
    const Json found = document(folder, {"verify", model, "--points", "4"});
    CHECK(found["verdict"] == "pass");
    CHECK(found["points"] == 4);
    CHECK(found["formulations"].size() > 4);
  }
}

TEST_CASE("verify: tolerances allow for rounding with large angles, distant places, stiff springs and weak forces") {
  const Folder folder;
  for (const auto& [parameters, force] :
       {std::pair{"F = 1\nw = 1e7", "generalized = { x = \"F*sin(w*t)\" }"},
        {"F = 1\nw = 0.1", "generalized = { x = \"F*exp(-((t - 5)/w)^2)\" }"},
        {"k = 100\nd = 1e8", "spring = { between = [\"P\", \"d*E1\"], stiffness = \"k\", length = \"d\" }"},
        {"k = 1e10\nd = 3", "spring = { between = [\"P\", \"d*E1\"], stiffness = \"k\", length = \"d\" }"}}) {
    const auto& shown = force;
    CAPTURE(shown);
    folder.write("sound.toml", particle_under(parameters, force));
    CHECK(document(folder, {"verify", "sound.toml", "--points", "6"})["verdict"] == "pass");
  }
}

TEST_CASE(
    "verify: a narrow force far from the sampled states passes, and so does an acceleration of 0 by cancelling terms") {
  const Folder folder;
  folder.write("pulse.toml", particle_under("", "generalized = { x = \"exp(-((t - 5)/0.01)^2)\" }"));
  CHECK(document(folder, {"verify", "pulse.toml", "--points", "4"})["verdict"] == "pass");
  // exp(-1e11) has about 4e10 zeros after the decimal point.
  folder.write("barrier.toml",
               "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"5*exp(-((x - "
               "3)/1e-5)^2)\"\n");
  CHECK(document(folder, {"verify", "barrier.toml", "--points", "4"})["verdict"] == "pass");
  // x moves uniformly, and y without inertia follows: by the null space x_ddot = cos(y) y_ddot - sin(y) y_dot^2 = 0.
  folder.write("follows.toml", R"toml(format = 1
[coordinates]
x = {}
y = {}
[energy]
kinetic = "1/2*x_dot^2"
[[constraint]]
name = "curve"
holonomic = "x - sin(y)"
)toml");
  CHECK(document(folder, {"verify", "follows.toml", "--points", "6"})["verdict"] == "pass");
}

// A climber moves along a ladder as a function of time: the power of that motion depends on the forces of the contacts.
TEST_CASE("verify: a prescribed motion on a body in contact") {
  const Folder folder;
  folder.write("climber.toml", R"toml(format = 1
[parameters]
L = "5 m"
v = "0.5 m/s"
[functions]
s = "v*t"
[[body]]
name = "ladder"
mass = "12 kg"
inertia = { principal = ["25 kg*m^2", "25 kg*m^2", 0] }
position = { cartesian = ["x", "0", "z"] }
rotation = { axis = "E2", angle = "th" }
[[particle]]
name = "climber"
mass = "75 kg"
position = "ladder + (s - L/2)*ladder.e3"
[[contact]]
name = "floor"
body = "ladder"
points = { foot = "-L/2*ladder.e3" }
on = "ground"
friction = { static = 0.3, dynamic = 0.3 }
[[contact]]
name = "wall"
body = "ladder"
points = { top = "L/2*ladder.e3" }
on = { point = "0[m]*E1", normal = "-E1" }
friction = { static = 0.3, dynamic = 0.3 }
[impacts]
law = "moreau"
[[force]]
gravity = "-9.81[m/s^2]*E3"
)toml");
  CHECK(document(folder, {"verify", "climber.toml", "--points", "3", "--no-compile"})["verdict"] == "pass");
}

TEST_CASE("run: shipped models with springs of 1e8 and 1e10 load their compiled code") {
  const Folder folder;
  for (const char* model : {"elastic_pendulum", "car_axis", "S4_two_particles"}) {
    for (const char* stiffness : {"k=1e8", "k=1e10"}) {
      CAPTURE(model);
      CAPTURE(stiffness);
      const Json found = document(folder, {"run", model, "--set", stiffness, "--t-end", "1e-4"});
      CHECK(found["outcome"] == "done");
    }
  }
}

TEST_CASE("verify: every shipped model passes with every function that can be emitted") {
  const Folder folder;
  for (const std::string& model : shipped_models()) {
    CAPTURE(model);
    CHECK(document(folder, {"verify", model, "--points", "1", "--no-compile"})["verdict"] == "pass");
  }
}

TEST_CASE("run: a body that falls into a corner of two walls comes to rest there, at any tolerance") {
  const Folder folder;
  folder.write("corner.toml", R"toml(format = 1
[parameters]
m = 1
g = 9.81
)toml" + particle_in_plane + R"toml([[constraint]]
name = "right"
holonomic = "y - 0.3*x"
holds = "unilateral"
[[constraint]]
name = "left"
holonomic = "y + 0.5*x"
holds = "unilateral"
[scene.default]
t = [0, 3]
initial = { x = 0, y = 1 }
)toml");
  // At rest the walls carry the weight: 0.3 r = 0.5 l, r + l = m g.
  for (const char* tolerance : {"1e-9", "1e-11", "1e-13"}) {
    CAPTURE(tolerance);
    const Json found =
        document(folder, {"run", "corner.toml", "--rtol", tolerance, "--atol", tolerance, "--max-steps", "20000"});
    CHECK(found["outcome"] == "done");
    CHECK(std::abs(found["final"]["x"].get<double>()) < 1e-6);
    CHECK(found["final"]["reaction.right"].get<double>() == doctest::Approx(9.81 * 0.5 / 0.8));
    CHECK(found["final"]["reaction.left"].get<double>() == doctest::Approx(9.81 * 0.3 / 0.8));
    CHECK(found["error_estimate_note"] == "");
  }
}

TEST_CASE("run: a body that bounces between the walls of a corner comes to rest there") {
  const Folder folder;
  const auto corner = [](const std::string& at) {
    return R"toml(format = 1
[parameters]
m = 1
g = 9.81
)toml" + particle_in_plane +
           R"toml([[constraint]]
name = "right"
holonomic = "(y - )toml" +
           at + R"toml() - 0.3*(x - )toml" + at + R"toml()"
holds = "unilateral"
restitution = 0.3
[[constraint]]
name = "left"
holonomic = "(y - )toml" +
           at + R"toml() + 0.5*(x - )toml" + at + R"toml()"
holds = "unilateral"
restitution = 0.3
[scene.default]
t = [0, 15]
initial = { x = )toml" +
           at + R"toml( , y = 3, x_dot = 0.3 }
)toml";
  };
  // Far from the origin gaps are less accurate. At the end both walls carry the weight: 0.3 r = 0.5 l, r + l = m g.
  for (const char* at : {"0", "1.7"}) {
    folder.write("bounces.toml", corner(at));
    for (const char* side : {"0.01", "0.2", "-0.5"}) {
      CAPTURE(at);
      CAPTURE(side);
      const std::string x = std::to_string(std::stod(at) + std::stod(side));
      const Json found =
          document(folder, {"run", "bounces.toml", "--set", "x=" + x, "--set", "x_dot=0.3", "--max-steps", "20000"});
      CHECK(found["outcome"] == "done");
      CHECK(std::abs(found["final"]["x"].get<double>() - std::stod(at)) < 1e-9);
      CHECK(std::abs(found["final"]["x_dot"].get<double>()) < 1e-9);
      CHECK(found["final"]["reaction.right"].get<double>() == doctest::Approx(9.81 * 0.5 / 0.8));
      CHECK(found["final"]["reaction.left"].get<double>() == doctest::Approx(9.81 * 0.3 / 0.8));
    }
  }
}
