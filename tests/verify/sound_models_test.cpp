// SPDX-License-Identifier: GPL-3.0-or-later
// Correct models that would fail if differences were relative to the wrong scale, or states were impossible.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

#include "error.hpp"
#include "support/particles.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

verify::Certificate certificate(const std::string& text, std::uint64_t seed = 1) {
  const model::Model model = model::read_model_text("format = 1\n" + text, "sound.toml");
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  return verify::verify(mechanics, {50, 6, seed});
}

void check_sound(const std::string& text, std::uint64_t seed = 1) {
  const verify::Certificate c = certificate(text, seed);
  INFO(c.summary());
  CHECK(c.pass);
  CHECK(c.points == 6);
}

/// A particle in a plane with gravity, and curves that it cannot cross.
std::string particle_above(const std::vector<std::string>& curves) {
  std::string text = R"toml(
[parameters]
m = 1
g = 9.81
)toml" + test::particle_in_plane;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    text += fmt::format("[[constraint]]\nname = \"c{}\"\nholonomic = \"{}\"\nholds = \"unilateral\"\n", k, curves[k]);
  }
  return text + "[scene.default]\nt = [0, 1]\ninitial = { x = 0.5, y = 2, x_dot = -1 }\n";
}

}  // namespace

TEST_CASE("sound models: accelerations that are exactly 0 where large terms cancel") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    check_sound(R"toml(
[parameters]
J1 = 2
J2 = 3
J3 = 5
M0 = 7
[coordinates]
a = "rad"
b = "rad"
c = "rad"
[energy]
kinetic = "J1/2*a_dot^2 + J2/2*(a_dot + b_dot)^2 + J3/2*(a_dot + b_dot + c_dot)^2"
[[force]]
generalized = { a = "M0" }
[scene.default]
t = [0, 1]
initial = { a_dot = 1 }
)toml",
                seed);
  }
}

TEST_CASE("sound models: a particle fixed in the corner of two curves") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    check_sound(particle_above({"y", "y - 0.3*x"}), seed);
    check_sound(particle_above({"y", "x"}), seed);
    check_sound(particle_above({"y - x/3", "y + x/7"}), seed);
  }
}

TEST_CASE("sound models: contacts that cannot be closed simultaneously are each closed at some states") {
  check_sound(particle_above({"y", "sqrt(x^2 + (y - 1)^2) - 0.2"}));
  check_sound(particle_above({"x", "1 - x"}));
  check_sound(particle_above({"y", "x", "1 - x"}));
}

TEST_CASE("sound models: a contact that repeats another one is still rejected") {
  CHECK_THROWS_AS(certificate(particle_above({"y", "2*y"})), Error);
  try {
    certificate(particle_above({"y", "2*y"}));
  } catch (const Error& error) {
    CHECK(error.message().find("follows from 'c0'") != std::string::npos);
  }
}

TEST_CASE("sound models: forces and energies of any size") {
  for (const char* width : {"0.3", "0.1", "0.01"}) {
    CAPTURE(width);
    check_sound(fmt::format(R"toml(
[parameters]
m = 1
F = 1
w = {}
[coordinates]
x = "m"
[[particle]]
name = "P"
mass = "m"
position = "x*E1"
[[force]]
generalized = {{ x = "F*exp(-((t - 5)/w)^2)" }}
[scene.default]
t = [0, 10]
initial = {{ x = 0 }}
)toml",
                            width));
  }
  for (const char* far : {"1e-9", "1e8", "1e12"}) {
    CAPTURE(far);
    check_sound(fmt::format(R"toml(
[parameters]
m = 1
k = 1e10
d = {0}
[[particle]]
name = "P"
mass = "m"
position = {{ cartesian = ["x", "y"] }}
[[force]]
spring = {{ between = ["P", "d*E1"], stiffness = "k", length = "d" }}
[scene.default]
t = [0, 1]
initial = {{ x = 0.5, y = 1 }}
)toml",
                            far));
  }
}

TEST_CASE("sound models: the other branch of `if` may be undefined") {
  for (const char* force : {"if(x > 0, sqrt(x), 0)", "if(x > 0, sqrt(x), -sqrt(-x))", "if(x > 0, log(x), 1/(x - 1))",
                            "if(x < 0, 0, x^1.5)"}) {
    CAPTURE(force);
    check_sound(fmt::format(R"toml(
[coordinates]
x = {{}}
[[particle]]
name = "P"
mass = 1
position = "x*E1"
[[force]]
generalized = {{ x = "{}" }}
[scene.default]
t = [0, 1]
initial = {{ x = 0.1, x_dot = -2 }}
)toml",
                            force));
  }
}

TEST_CASE("sound models: at rest in the corner of two oblique curves") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) check_sound(particle_above({"y - 0.3*x", "y + 0.5*x"}), seed);
}
