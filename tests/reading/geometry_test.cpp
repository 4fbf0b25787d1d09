// SPDX-License-Identifier: GPL-3.0-or-later
// Bases, metrics and Christoffel symbols against the tables of textbooks.
#include <doctest/doctest.h>

#include <map>

#include "reading/by_name.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::Geometry;

namespace {

struct Table {
  explicit Table(const std::string& model) : s(model::read_model(shipped(model))) {
    std::vector<Geometry> all = reading::geometry(s.mechanics);
    REQUIRE(all.size() == 1);
    g = all[0];
  }
  std::size_t at(const std::string& name) const {
    for (std::size_t i = 0; i < g.coordinates.size(); ++i) {
      if (s.model.coordinates[g.coordinates[i]].name == name) return i;
    }
    throw std::logic_error("no coordinate " + name);
  }
  Sum metric(const std::string& i, const std::string& k) const { return g.metric[at(i) * 3 + at(k)]; }
  /// All symbols of the second kind except those named must vanish.
  void check_second_kind(const std::map<std::array<std::string, 3>, Sum>& expected) const {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t k = 0; k < 3; ++k) {
          Sum value;
          for (const auto& [names, sum] : expected) {
            const std::size_t up = at(names[0]), a = at(names[1]), b = at(names[2]);
            if (up == k && ((a == i && b == j) || (a == j && b == i))) value = sum;
          }
          CHECK(same(g.second[(i * 3 + j) * 3 + k], value));
        }
      }
    }
  }
  System s;
  Geometry g;
};

}  // namespace

TEST_CASE("G1: spherical coordinates") {
  Table table("G1_spherical");
  const Sum R = table.s.symbol("R"), phi = table.s.symbol("phi");
  CHECK(table.metric("R", "R") == Sum(1));
  CHECK(table.metric("phi", "phi") == square(R));
  CHECK(same(table.metric("theta", "theta"), square(R * sin(phi))));
  CHECK(table.metric("R", "phi").is_zero());
  CHECK(same(table.g.determinant, reading::power(R, 4) * square(sin(phi))));
  table.check_second_kind({{{"R", "phi", "phi"}, -R},
                           {{"R", "theta", "theta"}, -R * square(sin(phi))},
                           {{"phi", "R", "phi"}, over(1, R)},
                           {{"phi", "theta", "theta"}, -sin(phi) * cos(phi)},
                           {{"theta", "R", "theta"}, over(1, R)},
                           {{"theta", "phi", "theta"}, over(cos(phi), sin(phi))}});
  // (1.20), (1.22) in unit vectors: a_theta = R sin(phi) e_theta, a^theta = e_theta / (R sin(phi))
  REQUIRE(table.g.covariant_unit.size() == 3);
  CHECK(same(table.g.covariant_unit[table.at("theta")][2], R * sin(phi)));
  CHECK(same(table.g.contravariant_unit[table.at("theta")][2], over(1, R * sin(phi))));
  CHECK(same(table.g.kinetic,
             half(table.s.symbol("m")) * (square(table.s.symbol("R_dot")) + square(R * table.s.symbol("phi_dot")) +
                                          square(R * sin(phi) * table.s.symbol("theta_dot")))));
}

TEST_CASE("G1: cylindrical and Cartesian coordinates") {
  Table table("G1_cylindrical");
  const Sum r = table.s.symbol("r");
  table.check_second_kind({{{"r", "theta", "theta"}, -r}, {{"theta", "r", "theta"}, over(1, r)}});
  Table flat("G1_cartesian");
  flat.check_second_kind({});
  CHECK(flat.g.determinant == Sum(1));
}

TEST_CASE("a_i . a^k is the unit matrix") {
  for (const char* name : {"G1_spherical", "G1_cylindrical", "G1_cartesian"}) {
    Table table(name);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        Sum product;
        for (std::size_t c = 0; c < 3; ++c) product += table.g.covariant[i][c] * table.g.contravariant[k][c];
        CHECK(same(product, Sum(i == k ? 1 : 0)));
      }
    }
  }
}

TEST_CASE("configuration manifold: helical coordinates have a metric that is not diagonal, (1.72)") {
  System s(model::read_model_text(R"(format = 1
[parameters]
m = 1
alpha = 0.3
[coordinates]
theta = {}
r = { range = [0, 10] }
nu = {}
[[particle]]
name = "P"
mass = "m"
position = "r*cos(theta)*E1 + r*sin(theta)*E2 + (nu + alpha*r*theta)*E3"
)",
                                  "helical"));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const auto g = reading::configuration_space(s.mechanics);
  REQUIRE(g);
  const Sum m = v("m"), al = v("alpha"), r = v("r"), th = v("theta");
  CHECK(same(g->metric[0], m * square(r) * (Sum(1) + square(al))));
  CHECK(same(g->metric[1], m * square(al) * r * th));
  CHECK(same(g->metric[4], m * (Sum(1) + square(al * th))));
  CHECK(same(g->metric[5], m * al * th));
  CHECK(same(g->determinant, m * m * m * square(r)));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      Sum product;
      for (std::size_t j = 0; j < 3; ++j) product += g->metric[i * 3 + j] * g->inverse[j * 3 + k];
      CHECK(same(product, Sum(i == k ? 1 : 0)));
    }
  }
}

TEST_CASE("configuration manifold: parabolic coordinates cancel u^2 + v^2") {
  System s(model::read_model_text(R"(format = 1
[parameters]
m = 1
[coordinates]
u = {}
v = {}
theta = {}
[[particle]]
name = "P"
mass = "m"
position = "u*v*cos(theta)*E1 + u*v*sin(theta)*E2 + (u^2 - v^2)/2*E3"
)",
                                  "parabolic"));
  const Sum m = s.symbol("m"), u = s.symbol("u"), v = s.symbol("v");
  const auto g = reading::configuration_space(s.mechanics);
  REQUIRE(g);
  CHECK(same(g->metric[0], m * (square(u) + square(v))));
  CHECK(same(g->metric[8], m * square(u * v)));
  // Gamma^u_uu = u/(u^2 + v^2), Gamma^theta_u theta = 1/u
  CHECK(g->second[0] == over(u, square(u) + square(v)));
  CHECK(g->second[(0 * 3 + 2) * 3 + 2] == over(1, u));
}

TEST_CASE("singular sets are reported per approach") {
  System s(model::read_model(shipped("P7_moving_sphere")));
  std::map<std::string, std::vector<Sum>> sets;
  for (const reading::SingularSet& set : reading::singular_sets(s.mechanics)) sets[set.approach].push_back(set.factor);
  REQUIRE(sets["I"].size() == 1);
  CHECK(sets["I"][0] == s.symbol("R"));
  REQUIRE(sets["both"].size() == 1);
  CHECK(sets["both"][0] == sin(s.symbol("phi")));
  REQUIRE(sets["II"].size() == 1);
  CHECK(sets["II"][0] == s.symbol("d"));
  System kepler(model::read_model(shipped("P14_kepler_cartesian")));
  const auto of_kepler = reading::singular_sets(kepler.mechanics);
  REQUIRE(of_kepler.size() == 1);
  CHECK(of_kepler[0].factor == square(kepler.symbol("x")) + square(kepler.symbol("y")) + square(kepler.symbol("z")));
  System pendulum(model::read_model(shipped("cart_pendulum")));
  CHECK(reading::singular_sets(pendulum.mechanics).empty());
}

TEST_CASE("a determinant of masses gives a singular set only if it vanishes somewhere") {
  const std::string parameters =
      "format = 1\n[parameters]\nm = 1\nM = 2\nl = 1\nL = 1.5\nJ = 0.1\nK = 0.2\n[coordinates]\na = {}\nb = {}\n";
  const auto body = [](const std::string& name, const std::string& mass, const std::string& inertia,
                       const std::string& position, const std::string& angle) {
    return "[[body]]\nname = \"" + name + "\"\nmass = \"" + mass + "\"\ninertia = \"" + inertia + "\"\nposition = \"" +
           position + "\"\nrotation = { axis = \"E3\", angle = \"" + angle + "\" }\n";
  };
  System arm(model::read_model_text(
      parameters + body("A", "m", "J", "l*A.e1", "a") + body("B", "M", "K", "L*A.e1 + l*B.e1", "a + b"), "arm"));
  CHECK(reading::singular_sets(arm.mechanics).empty());
  // Stretched or folded, an arm of two massless bars cannot move its mass along itself.
  System folded(model::read_model_text(parameters + "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = "
                                                    "\"l*(cos(a)*E1 + sin(a)*E2) + L*(cos(b)*E1 + sin(b)*E2)\"\n",
                                       "folded"));
  CHECK_FALSE(reading::singular_sets(folded.mechanics).empty());
}
