// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/expand_contacts.hpp"

#include <doctest/doctest.h>

#include <string>

#include "error.hpp"
#include "model/model.hpp"

using namespace eomgen;
using model::read_model_text;

namespace {

const std::string box = R"(format = 1
[parameters]
m = "1 kg"
a = "0.3 m"
[[body]]
name = "box"
mass = "m"
inertia = { principal = ["m*a^2", "m*a^2", "m*a^2"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler_parameters = ["p0", "p1", "p2", "p3"] }
)";

std::string error_of(const std::string& contact) {
  try {
    read_model_text(box + contact, "t.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::size_t unilateral(const model::Model& model) {
  std::size_t count = 0;
  for (const model::Constraint& constraint : model.constraints) count += constraint.unilateral ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("contact tables: corners, points and limits become constraints with names and laws of their own") {
  const model::Model model = read_model_text(box + R"(
[[contact]]
name = "feet"
body = "box"
corners = ["a", "a/2", 0.1]
on = "ground"
restitution = 0.3
friction = { static = 0.5, dynamic = 0.4 }
[[contact]]
name = "tip"
body = "box"
points = { nose = "a*box.e1" }
on = { point = "0*E1", normal = "E1" }
[[contact]]
name = "stop"
limits = { x = ["-a", "2*a"], y = [0, 1] }
)",
                                             "t.toml");
  CHECK(unilateral(model) == 13);
  const auto named = [&](const std::string& name) {
    for (const model::Constraint& constraint : model.constraints)
      if (constraint.name == name) return constraint;
    FAIL(name);
    return model::Constraint{};
  };
  CHECK(named("feet_8").friction.has_value());
  CHECK(named("feet_8").restitution != model::no_node);
  CHECK_FALSE(named("tip_nose").friction.has_value());
  CHECK(named("stop_x_lower").unilateral);
  CHECK(named("stop_y_upper").unilateral);
}

TEST_CASE("contact tables: vectors may be three components") {
  const auto gap = [](const std::string& contact) {
    const model::Model model = read_model_text(box + contact, "t.toml");
    REQUIRE(unilateral(model) == 1);
    return model.constraints.front().name;
  };
  CHECK_FALSE(
      gap("[[contact]]\nname = \"c\"\nbody = \"box\"\npoints = { p = [0, \"a\", \"-a/2\"] }\non = { point = [0, 0, "
          "0], normal = [0, 0, 1] }\n")
          .empty());
  CHECK_FALSE(gap("[[contact]]\nname = \"c\"\nbody = \"box\"\nshape = { sphere = 0.1 }\non = { cylinder = 1, point = "
                  "[0, 1, 0], "
                  "axis = [1, 0, 0] }\n")
                  .empty());
  CHECK(error_of("[[contact]]\nname = \"c\"\nbody = \"box\"\npoints = { p = [0, 1] }\non = \"ground\"\n")
            .find("gives a point with 2 components") != std::string::npos);
}

TEST_CASE("contact tables: limits have units, as other values have") {
  const auto with = [](const std::string& lower) {
    return read_model_text(box + "[[contact]]\nname = \"stop\"\nlimits = { x = [\"" + lower + "\", \"2 m\"] }\n",
                           "t.toml");
  };
  for (const char* lower : {"-20 cm", "-0.2 m ", "-0.2[m]"}) CHECK(unilateral(with(lower)) == 2);
  CHECK_THROWS_AS(with("-1 kg"), Error);
}

TEST_CASE("contact tables: every pair of spheres touches") {
  const model::Model model = read_model_text(R"(format = 1
[parameters]
m = "1 kg"
R = "0.1 m"
[[particle]]
name = "A"
mass = "m"
position = ["x1", "y1", 0]
[[particle]]
name = "B"
mass = "m"
position = ["x2", "y2", 0]
[[particle]]
name = "C"
mass = "m"
position = ["x3", "y3", 0]
[coordinates]
x1 = "m"
y1 = "m"
x2 = "m"
y2 = "m"
x3 = "m"
y3 = "m"
[[contact]]
name = "pile"
spheres = ["A", "B", "C"]
radius = "R"
)",
                                             "t.toml");
  CHECK(unilateral(model) == 3);
}

TEST_CASE("contact tables: errors say what is wrong and where") {
  CHECK(error_of("[[contact]]\nname = \"c\"\n").find("what touches what") != std::string::npos);
  CHECK(error_of("[[contact]]\nname = \"c\"\nlimits = { x = [1] }\n").find("1 limits of 'x'") != std::string::npos);
  for (const char* wrong : {"[1, -1]", "[1, 1]", "[\"2.5\", 1]", "[\"2[m]\", \"1[m]\"]"}) {
    CAPTURE(std::string(wrong));
    CHECK(error_of("[[contact]]\nname = \"c\"\nlimits = { x = " + std::string(wrong) + " }\n")
              .find("the lower one is not below the upper one") != std::string::npos);
  }
  CHECK(error_of("[[contact]]\nname = \"c\"\nlimits = { x = [0, 1] }\nbdoy = \"box\"\n").find("has no key 'bdoy'") !=
        std::string::npos);
  CHECK(error_of("[[contact]]\nname = \"c\"\ncorners = [1, 2, 3]\non = \"ground\"\n").find("has no body") !=
        std::string::npos);
  CHECK(error_of("[[contact]]\nname = \"c\"\nspheres = [\"box\"]\nradius = 1\n").find("needs two spheres") !=
        std::string::npos);
  CHECK(error_of("[[contact]]\nname = \"c\"\nparticles = [\"P\"]\non = \"box\"\n").find("puts particles on 'box'") !=
        std::string::npos);
  CHECK(error_of("[[contact]]\nname = \"c\"\nparticles = [\"P\"]\non = { normal = \"E3\" }\n")
            .find("a plane without a point") != std::string::npos);
  CHECK(error_of("[contact]\nname = \"c\"\n").find("[[contact]] with two brackets") != std::string::npos);
}
