// SPDX-License-Identifier: GPL-3.0-or-later
// The direction of sliding and the length of the gradient, for particles whose coordinates are more than dimensions.
#include <doctest/doctest.h>

#include "mechanics/mechanics.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

using namespace eomgen;

namespace {

// The end of a chain of rods on a slider: COUNT angles and the slider's height place a point of the plane.
std::string chain(int count, const std::string& psi) {
  std::string x = "0*l", y = "h", energy = "m*h_dot^2", coordinates = "h = \"m\"\n";
  for (int k = 1; k <= count; ++k) {
    const std::string angle = "a" + std::to_string(k);
    coordinates += angle + " = \"rad\"\n";
    x += " + 2*l*sin(" + angle + ")", y += " - 3*l*cos(" + angle + ")", energy += " + m*l^2*" + angle + "_dot^2";
  }
  return "format = 1\n[parameters]\nl = \"1 m\"\nm = \"1 kg\"\n[coordinates]\n" + coordinates +
         "[energy]\nkinetic = \"(" + energy + ")/2\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\n" +
         "position = { cartesian = [\"" + x + "\", \"" + y + "\"] }\n[[constraint]]\nname = \"wall\"\n" +
         "holonomic = \"" + psi + "\"\nholds = \"unilateral\"\nfriction = { static = 0.3, dynamic = 0.2 }\n";
}

double value(const mechanics::Mechanics& m, symbolic::Ref expression) {
  return cln::double_approx(symbolic::evaluate(
      *m.dag, {expression}, [](const symbolic::Symbol& s) -> cln::cl_R { return symbolic::sample(s, 3); }, 30)[0]);
}

}  // namespace

TEST_CASE("mechanics: friction acts on a particle in the plane with any number of coordinates") {
  for (int count = 1; count <= 4; ++count) {
    CAPTURE(count);
    const mechanics::Mechanics m =
        mechanics::build_mechanics(model::read_model_text(chain(count, "3*dot(P, E1) + 4*dot(P, E2) - 7*l"), "c.toml"));
    REQUIRE(m.contacts.size() == 1);
    const mechanics::Contact& wall = m.contacts[0];
    REQUIRE(wall.dimensions() == 1);
    // grad psi = (3, 4, 0), e_t = (4, -3, 0)/5.
    CHECK(value(m, wall.gram[0]) == doctest::Approx(25).epsilon(1e-12));
    const double x = value(m, wall.directions[0][0]), y = value(m, wall.directions[0][1]);
    CHECK(3 * x + 4 * y == doctest::Approx(0).epsilon(1e-12));
    CHECK(x * x + y * y == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("mechanics: friction acts at the point that the constraint names, which needs no mass") {
  const std::string point =
      "[[point]]\nname = \"tip\"\nposition = { cartesian = [\"l*sin(a1)\", \"h - l*cos(a1)\"] }\n";
  const model::Model model = model::read_model_text(chain(1, "dot(tip, E1)") + point, "c.toml");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  REQUIRE(m.contacts.size() == 1);
  CHECK(m.model->places[m.contacts[0].place].name == "tip");
}

TEST_CASE("mechanics rejects: friction on a constraint that is no function of the particle's position") {
  const model::Model model = model::read_model_text(chain(2, "dot(P, E1) + l*a2"), "c.toml");
  CHECK_THROWS_WITH_AS(mechanics::build_mechanics(model),
                       doctest::Contains("'wall' depends on 'a2' otherwise than by the position of 'P'"), Error);
}

TEST_CASE("mechanics rejects: friction where the coordinates of the particle are singular") {
  // On the axis, psi = z + f(phi) has no gradient: phi changes and the position does not.
  const auto wire = [](const std::string& position, const std::string& psi) {
    return "format = 1\n[parameters]\nm = { value = 1, positive = true }\nk = 0.3\n[[particle]]\nname = \"P\"\n"
           "mass = \"m\"\nposition = { " +
           position + " }\n[[force]]\ngravity = \"-9.81*E3\"\n[[constraint]]\nname = \"wire\"\nholonomic = [" + psi +
           "]\nfriction = { ";
  };
  for (const char* position :
       {"cylindrical = [\"r\", \"phi\", \"z\"]", "helical = [\"phi\", \"r\", \"z\"], pitch = \"k\""}) {
    for (const char* law : {"static = 0.3, dynamic = 0.2 }\n", "law = \"smooth\", dynamic = 0.2, width = 0.01 }\n"}) {
      CAPTURE(position);
      CAPTURE(law);
      const std::string on_axis = wire(position, "\"r\", \"z - k*phi\"") + law;
      CHECK_THROWS_WITH_AS(mechanics::build_mechanics(model::read_model_text(on_axis, "w.toml")),
                           doctest::Contains("the friction of 'wire' has no direction"), Error);
      const std::string beside = wire(position, "\"r - 1\", \"z - k*phi\"") + law;
      CHECK_NOTHROW(mechanics::build_mechanics(model::read_model_text(beside, "w.toml")));
    }
  }
}
