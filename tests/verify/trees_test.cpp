// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of particles: the formulations that accept them, and the agreement of these with d'Alembert's principle.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <set>
#include <string>

#include "derive/trees/quasi_coordinates.hpp"
#include "model/model.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

const std::string tree_parameters = R"toml(format = 1
[parameters]
m0 = "2 kg"
m1 = "1 kg"
m2 = "0.5 kg"
m3 = "0.7 kg"
L1 = "1 m"
L2 = "0.8 m"
w = "3 rad/s"
g = "9.81 m/s^2"
k = "30 N/m"
c = "0.2 N*s/m"
ct = "0.1 N*m*s"
[inputs]
F = { unit = "N", default = 0 }
)toml";

// A cart on a shaking table, a rod on it, and two rods at the end of this rod; B has a relative angle.
const std::string planar_tree = tree_parameters + R"toml([coordinates]
beta = "rad"
[[particle]]
name = "cart"
mass = "m0"
position = { cartesian = ["x", "L1/10*sin(w*t)"] }
[[particle]]
name = "A"
mass = "m1"
position = { cylindrical = ["L1", "alpha"], from = "cart" }
[[particle]]
name = "B"
mass = "m2"
position = { cylindrical = ["L2", "alpha + beta"], from = "A" }
[[particle]]
name = "C"
mass = "m3"
position = { cylindrical = ["L2", "gamma"], from = "A" }
[[force]]
gravity = "-g*E2"
[[force]]
spring = { between = ["B", "C"], stiffness = "k", length = "L2" }
[[force]]
damper = { between = ["B", "cart"], coefficient = "c" }
[[force]]
generalized = { x = "F", beta = "-ct*beta_dot" }
)toml";

const std::string spatial_tree = planar_tree + R"toml([[particle]]
name = "D"
mass = "m3"
position = { spherical = ["r", "phi", "psi"], from = "cart" }
)toml";

const std::string growing_mass = tree_parameters + R"toml([[particle]]
name = "A"
mass = "m1 + m2*sin(w*t)/4"
position = { cylindrical = ["L1", "alpha"] }
[[particle]]
name = "B"
mass = "m2"
position = { cylindrical = ["L2", "beta"], from = "A" }
[[force]]
gravity = "-g*E2"
)toml";

// B is attached to A and to C: not a tree.
const std::string closed = tree_parameters + R"toml([coordinates]
alpha = "rad"
gamma = "rad"
[[particle]]
name = "A"
mass = "m1"
position = { cylindrical = ["L1", "alpha"] }
[[particle]]
name = "C"
mass = "m1"
position = { cylindrical = ["L1", "gamma"] }
[[particle]]
name = "B"
mass = "m2"
position = "(A + C)/2"
)toml";

std::string chain(int n, const std::string& angles) {
  return tree_parameters + "[[chain]]\nname = \"link\"\nn = " + std::to_string(n) +
         "\nmass = \"m1\"\nlength = \"L1\"\nangles = \"" + angles + "\"\n[[force]]\ngravity = \"-g*E2\"\n";
}

std::set<std::string> formulations_that_agree(const std::string& text) {
  const model::Model model = model::read_model_text(text, "tree");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(m);
  const verify::Certificate certificate = verify::certify(m, subjects, {40, 4, 1});
  INFO(certificate.summary());
  CHECK(certificate.pass);
  std::set<std::string> names;
  for (const system::EquationSystem& s : subjects.systems) names.insert(s.formulation);
  return names;
}

void check_tree_formulations(const std::string& text, bool recursive, bool articulated) {
  const std::set<std::string> names = formulations_that_agree(text);
  CHECK(names.contains("recursive") == recursive);
  CHECK(names.contains("articulated") == articulated);
}

}  // namespace

TEST_CASE("trees: a planar tree on a shaken table, with springs, dampers and inputs") {
  check_tree_formulations(planar_tree, true, true);
}
TEST_CASE("trees: a cart in space carries planar rods and a free particle") {
  check_tree_formulations(spatial_tree, true, true);
}
TEST_CASE("trees: with a varying mass the tensions do not follow from accelerations alone") {
  check_tree_formulations(growing_mass, true, false);
}
TEST_CASE("trees: a particle between two others closes a loop") { check_tree_formulations(closed, false, false); }
TEST_CASE("trees: chains in absolute and in relative angles") {
  for (const char* angles : {"absolute", "relative"}) check_tree_formulations(chain(5, angles), true, true);
}

TEST_CASE("quasi-coordinates: the running sums of relative angles; none if positions contain no sums") {
  const auto of_chain = [](const char* angles) {
    static model::Model model;
    model = model::read_model_text(chain(3, angles), "chain");
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    std::vector<mechanics::Vec3> positions;
    for (const mechanics::PointMass& mass : m.masses) positions.push_back(mass.position);
    return derive::quasi_coordinates(*m.dag, m.free, positions);
  };
  const derive::QuasiCoordinates sums = of_chain("relative");
  REQUIRE(!sums.identity());
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(sums.S[a * 3 + i] == (i <= a ? 1 : 0));
      CHECK(sums.S_inverse[a * 3 + i] == (i == a ? 1 : i + 1 == a ? -1 : 0));
    }
  }
  CHECK(of_chain("absolute").identity());
}

TEST_CASE("quasi-coordinates: hundreds of coordinates that occur one by one in positions are not changed") {
  std::string text = "format = 1\n";
  for (int i = 0; i < 333; ++i) {
    text += fmt::format(
        "[[particle]]\nname = \"P{0}\"\nmass = 1\nposition = {{ cartesian = [\"x{0}\", \"y{0}\", \"z{0}\"] }}\n", i);
  }
  const model::Model model = model::read_model_text(text, "free");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  std::vector<mechanics::Vec3> positions;
  for (const mechanics::PointMass& mass : m.masses) positions.push_back(mass.position);
  CHECK(derive::quasi_coordinates(*m.dag, m.free, positions).identity());
}

namespace {

// Four rods with particles at their ends, by energies alone: one velocity written out, one particle with y before x,
// one with opposite signs.
const std::string energies_of_rods = tree_parameters + R"toml([coordinates]
a1 = "rad"
a2 = "rad"
a3 = "rad"
a4 = "rad"
[definitions]
x1 = "L1*cos(a1)"
y1 = "L1*sin(a1)"
x2 = "x1 + L2*cos(a2)"
y2 = "y1 + L2*sin(a2)"
x3 = "x2 + L1*cos(a3)"
y3 = "y2 + L1*sin(a3)"
x4 = "x3 + L2*cos(a4)"
y4 = "y3 + L2*sin(a4)"
[energy]
potential = "k*L1^2/2*((a1 - a2)^2 + (a2 - a3)^2 + (a3 - a4)^2) + g*(m0*y1 + m1*y2 + m2*y3 + m3*y4)"
)toml";

const std::string squares_of_rods =
    "m0/2*(ddt(x1)^2 + ddt(y1)^2) + m1/2*(L1*sin(a1)*a1_dot + L2*sin(a2)*a2_dot)^2 + m1/2*ddt(y2)^2 + m2/2*(ddt(y3)^2 "
    "+ ddt(x3)^2)"
    " + m3/2*((-ddt(x4))^2 + ddt(0 - y4)^2)";

}  // namespace

TEST_CASE("trees: a kinetic energy that is a sum of squared velocities of points counts as that of particles") {
  check_tree_formulations(energies_of_rods + "kinetic = \"" + squares_of_rods + "\"\n", true, true);
}

TEST_CASE("trees: other kinetic energies, and systems that are not trees, are left to other formulations") {
  for (const char* more :
       {" + m0*L1^2/2*a2_dot^2", " + m0*L1^2/4*a1_dot*a2_dot", " + m0/2*(sin(a1)*sin(a2)*L1*a1_dot)^2"}) {
    CAPTURE(more);
    check_tree_formulations(energies_of_rods + "kinetic = \"" + squares_of_rods + more + "\"\n", false, false);
  }
}
