// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of particles: which routes take them, and that what these give is what d'Alembert's principle asks.
#include <doctest/doctest.h>

#include <set>
#include <string>

#include "derive/quasi_coordinates.hpp"
#include "model/model.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

const std::string parameters = R"toml(format = 1
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

// A cart on a table that shakes, a rod on it, and two rods on that one's end; B is told by a relative angle.
const std::string planar_tree = parameters + R"toml([coordinates]
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

const std::string growing_mass = parameters + R"toml([[particle]]
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

// B hangs on A and on C: no tree.
const std::string closed = parameters + R"toml([coordinates]
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
  return parameters + "[[chain]]\nname = \"link\"\nn = " + std::to_string(n) + "\nmass = \"m1\"\nlength = \"L1\"\nangles = \"" +
         angles + "\"\n[[force]]\ngravity = \"-g*E2\"\n";
}

std::set<std::string> routes_that_agree(const std::string& text) {
  const model::Model model = model::read_model_text(text, "tree");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  verify::Subjects subjects;
  subjects.systems = verify::all_routes(m);
  const verify::Certificate certificate = verify::certify(m, subjects, {40, 4, 1});
  INFO(certificate.summary());
  CHECK(certificate.pass);
  std::set<std::string> names;
  for (const system::EquationSystem& s : subjects.systems) names.insert(s.route);
  return names;
}

void check_tree_routes(const std::string& text, bool recursive, bool articulated) {
  const std::set<std::string> names = routes_that_agree(text);
  CHECK(names.contains("recursive") == recursive);
  CHECK(names.contains("articulated") == articulated);
}

}  // namespace

TEST_CASE("trees: a planar tree on a shaken table, with springs, dampers and inputs") {
  check_tree_routes(planar_tree, true, true);
}
TEST_CASE("trees: a cart in space carries planar rods and a free particle") { check_tree_routes(spatial_tree, true, true); }
TEST_CASE("trees: a mass that varies has no tensions that are told by accelerations alone") {
  check_tree_routes(growing_mass, true, false);
}
TEST_CASE("trees: a particle between two others closes a loop") { check_tree_routes(closed, false, false); }
TEST_CASE("trees: chains in absolute and in relative angles") {
  for (const char* angles : {"absolute", "relative"}) check_tree_routes(chain(5, angles), true, true);
}

TEST_CASE("quasi-coordinates: the running sums of relative angles, and nothing where positions use no sums") {
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
