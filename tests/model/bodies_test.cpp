// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "model_support.hpp"

using namespace eomgen::model;

namespace {

Model with_inertia(const std::string& inertia,
                   const std::string& rotation = "{ euler = \"321\", angles = [\"a\", \"b\", \"c\"] }") {
  return read("format = 1\n[parameters]\nm = 12\nR = 5\n[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = " + inertia +
              "\nrotation = " + rotation + "\n");
}

std::array<Rational, 3> moments(const Model& model) {
  const auto& J = model.bodies.at(0).inertia;
  return {exact(model, J[0][0]), exact(model, J[1][1]), exact(model, J[2][2])};
}

}  // namespace

TEST_CASE("shapes have the moments of homogeneous bodies") {
  using Moments = std::array<Rational, 3>;
  CHECK(moments(with_inertia("{ sphere = \"R\" }")) == Moments{120, 120, 120});
  CHECK(moments(with_inertia("{ disk = \"R\" }")) == Moments{75, 75, 150});
  CHECK(moments(with_inertia("{ cylinder = [\"R\", 2] }")) == Moments{79, 79, 150});
  CHECK(moments(with_inertia("{ rod = 3 }")) == Moments{9, 9, 0});
  CHECK(moments(with_inertia("{ box = [1, 2, 3] }")) == Moments{13, 10, 5});
}

TEST_CASE("an inertia is principal, a symmetric matrix, or one moment about a fixed axis") {
  const Model matrix = with_inertia("[[2, \"R/10\", 0], [\"R/10\", 3, 0], [0, 0, 4]]");
  CHECK(exact(matrix, matrix.bodies[0].inertia[0][1]) == ratio(1, 2));
  CHECK(exact(matrix, matrix.bodies[0].inertia[1][0]) == ratio(1, 2));
  CHECK(moments(with_inertia("7", "{ axis = \"E2\", angle = \"a\" }")) == std::array<Rational, 3>{0, 7, 0});
}

TEST_CASE("one moment suffices for a body relative to one that rotates about the same axis") {
  const Model model = read(
      "format = 1\n[[body]]\nname = \"A\"\nmass = 1\ninertia = 2\nrotation = { axis = \"E3\", angle = \"a\" }\n"
      "[[body]]\nname = \"B\"\nmass = 1\ninertia = 3\nrotation = { axis = \"A.e3\", angle = \"b\" }\nrelative_to = "
      "\"A\"\n");
  CHECK(exact(model, model.bodies[1].inertia[2][2]) == 3);
  CHECK(model.frames[2].parent == 1);
}

TEST_CASE("coordinates are in the order of the file: position, then rotation, of one body after the other") {
  const Model model = read(
      "format = 1\n[[body]]\nname = \"A\"\nmass = 1\ninertia = { sphere = 1 }\nrotation = { euler = \"123\", angles = "
      "[\"a\", \"b\", \"c\"] }\n"
      "position = { cartesian = [\"x\", \"y\", \"z\"] }\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian "
      "= [\"s\"  , \"0\"] }\n"
      "[[frame]]\nname = \"F\"\nrotation = { axis = \"E3\", angle = \"f\" }\n");
  std::string names;
  for (const Coordinate& q : model.coordinates) names += q.name + " ";
  CHECK(names == "x y z a b c s f ");
}

TEST_CASE("Euler parameters add a constraint of unit norm, and their default initial value is e0 = 1") {
  const Model model = with_inertia("{ sphere = \"R\" }", "{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }");
  REQUIRE(model.constraints.size() == 1);
  CHECK(model.constraints[0].name == "B_unit");
  REQUIRE(model.scenes[0].initial.size() == 4);
  for (const InitialValue& start : model.scenes[0].initial) {
    CHECK(exact(model, start.value) == (model.coordinates[start.coordinate].name == "e0" ? 1 : 0));
  }
}

TEST_CASE("a point on a body is its centre of mass and components along its axes") {
  const Model model = read(
      "format = 1\n[[body]]\nname = \"A\"\nmass = 1\ninertia = { sphere = 1 }\nrotation = { axis = \"E3\", angle = "
      "\"a\" }\n"
      "[[point]]\nname = \"P\"\non = \"A\"\nat = [2, 0, 0]\n");
  const Node& sum = model.arena[model.places[2].position];
  CHECK(sum.op == Op::add);
  CHECK(model.arena[model.arena[sum.args[1]].args[1]].op == Op::axis);
}

TEST_CASE("a pin given at the start may have an axis of a body that is rotated about an oblique axis") {
  const Model model = read(
      "format = 1\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { sphere = 1 }\nposition = { cartesian = [\"x\", \"y\"] "
      "}\nrotation = { axis = \"E1 + E2\", angle = \"q\" }\n"
      "[[joint]]\nname = \"j\"\ntype = \"pin\"\nbodies = [\"ground\", \"B\"]\nat = \"B\"\naxis = \"B.e3\"\n"
      "[scene.default]\ninitial = { q = 0.3 }\n");
  CHECK(model.constraints.at(0).psi.size() == 5);
}

TEST_CASE("a pin of bodies in plane motion has its axis in E3 for every start, given once or for both bodies") {
  const auto linkage = [](const std::string& axis) {
    std::string text = "format = 1\n";
    for (const std::string n : {"1", "2"})
      text += "[[body]]\nname = \"B" + n + "\"\nmass = 1\ninertia = 1\nposition = { cartesian = [\"x" + n + "\", \"y" +
              n + "\"] }\nrotation = { axis = \"E3\", angle = \"q" + n + "\" }\n";
    return read(text +
                "[[joint]]\nname = \"foot\"\ntype = \"ball\"\nbodies = [\"ground\", \"B1\"]\nat = [\"origin\", "
                "\"B1 - B1.e1\"]\n"
                "[[joint]]\nname = \"j\"\ntype = \"pin\"\nbodies = [\"B1\", \"B2\"]\nat = [\"B1 + B1.e1\", \"B2 - "
                "B2.e1\"]\naxis = " +
                axis + "\n[scene.default]\ninitial = { q1_dot = 1 }\n");
  };
  const std::size_t own = linkage("[\"B1.e3\", \"B2.e3\"]").arena.nodes.size();
  for (const char* axis : {"\"E3\"", "[\"E3\", \"E3\"]", "[\"E3\", \"B2.e3\"]"}) {
    CAPTURE(axis);
    const Model model = linkage(axis);
    CHECK(model.constraints.at(1).psi.size() == 5);
    CHECK(model.arena.nodes.size() < own + 20);
  }
  CHECK_THROWS_AS(linkage("[\"E1\", \"E1\"]"), eomgen::Error);
}

TEST_CASE("bodies: armatures that are bare numbers cause no warning, with coordinates in m and in rad") {
  const Model bare = read(R"toml(format = 1
[parameters]
m = "2 kg"
[coordinates]
x = { unit = "m", armature = 0.4 }
q = { armature = "0.03" }
[[body]]
name = "A"
mass = "m"
inertia = { principal = ["0.3 kg*m^2", "0.3 kg*m^2", "0.3 kg*m^2"] }
position = ["x", 0, 0]
rotation = { axis = "E3", angle = "q" }
)toml");
  CHECK(bare.warnings.empty());
  CHECK(bare.energy.kinetic != no_node);
}

TEST_CASE("bodies: a sphere or disk in contact is drawn as such, unless [draw] gives the body a shape") {
  const auto drawn = [](const std::string& contact, const std::string& more) {
    return read(
               "format = 1\n[parameters]\nm = 2\nR = 0.1\nS = 0.3\n[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = "
               "\"m*R^2\"\n"
               "position = { cartesian = [\"x\", \"0\", \"z\"] }\nrotation = { axis = \"E2\", angle = \"q\" }\n"
               "[[constraint]]\nname = \"floor\"\nsliding = { body = \"B\", on = \"ground\", " +
               contact + " }\n" + more)
        .drawn;
  };
  const auto ball = drawn("shape = { sphere = \"R\" }", "");
  REQUIRE(ball.size() == 1);
  CHECK(ball[0].kind == "sphere");
  CHECK(ball[0].lengths.size() == 1);
  const auto box = drawn("shape = { sphere = \"R\" }", "[draw]\nB = { box = [\"S\", \"S\", \"S\"] }\n");
  REQUIRE(box.size() == 1);
  CHECK(box[0].kind == "box");
  CHECK(drawn("at = \"-R*E3\"", "").empty());
}

TEST_CASE("an angular velocity at the start and 'solve' for a rate of its angles exclude one another") {
  const auto with_scene = [](const std::string& scene) {
    return refusal(
        "format = 1\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 2, 2.5] }\nrotation = { euler "
        "= \"313\", angles = [\"a\", \"b\", \"c\"] }\n[scene.default]\ninitial = { b = 1, " +
        scene);
  };
  CHECK(with_scene("\"B.omega\" = [1, 2, 3] }\n") == "accepted");
  CHECK(with_scene("\"B.omega\" = [1, 2, 3] }\nsolve = [\"a_dot\"]\n") ==
        "'a_dot' in 'solve' follows from 'B.omega', which stays as it is given");
  CHECK(with_scene("\"B.omega\" = [1, 2, 3], a_dot = 1 }\n") ==
        "'a_dot' is given, and it follows from 'B.omega' of this scene");
}
