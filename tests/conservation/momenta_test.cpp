// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "conservation/conserved.hpp"
#include "derive/formulations/lagrange.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

struct Found {
  model::Model model;
  mechanics::Mechanics m;
  system::EquationSystem s;
  std::vector<conservation::ConservedQuantity> conserved;

  explicit Found(const std::string& text) : model(model::read_model_text(text, "momenta")) {
    m = mechanics::build_mechanics(model);
    s = derive::lagrange(m, system::Approach::two);
    conserved = conservation::conserved_quantities(m, s);
  }
  Found(const Found&) = delete;

  const conservation::ConservedQuantity* named(const std::string& name) const {
    const auto found = std::find_if(conserved.begin(), conserved.end(), [&](const auto& c) { return c.name == name; });
    return found == conserved.end() ? nullptr : &*found;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const conservation::ConservedQuantity& c : conserved) result.push_back(c.name);
    return result;
  }
};

std::string kepler(const std::string& more = "") {
  return R"toml(format = 1
[parameters]
m = 1
GM = 1
g = 1
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[force]]
central_gravity = { GM = "GM" }
)toml" + more;
}

// Three masses on rods, the first free; `more` may add forces.
std::string free_chain(const std::string& more = "") {
  return R"toml(format = 1
[parameters]
m = 1
L = 1
g = 9.81
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[chain]]
name = "link"
n = 2
mass = "m"
length = "L"
from = "P"
)toml" + more;
}

}  // namespace

TEST_CASE("momenta: Kepler's problem in Cartesian coordinates provably conserves the angular momentum") {
  const Found found(kepler());
  CHECK(found.names() ==
        std::vector<std::string>{"energy", "angular_momentum.E1", "angular_momentum.E2", "angular_momentum.E3"});
  for (const conservation::ConservedQuantity& c : found.conserved)
    CHECK(c.certainty == conservation::Certainty::proven);
}

TEST_CASE("momenta: the result is r x m v, and its magnitude the sum of the magnitudes of its terms") {
  const Found found(kepler());
  const conservation::ConservedQuantity* h = found.named("angular_momentum.E2");
  REQUIRE(h != nullptr);
  const auto value = [](const symbolic::Symbol& s) {
    if (s.kind == symbolic::SymbolKind::parameter) return 2.0;  // m
    return 1.0 + s.index + 10.0 * s.order;                      // r = (1, 2, 3), v = (11, 12, 13)
  };
  const std::vector<double> values = symbolic::evaluate(*found.m.dag, {h->expression, *h->magnitude}, value);
  CHECK(values[0] == doctest::Approx(2.0 * (3 * 11 - 1 * 13)));
  CHECK(values[1] == doctest::Approx(2.0 * std::sqrt(14.0) * std::sqrt(434.0)));
}

TEST_CASE("momenta: uniform gravity along E2 conserves only components on which it does no work") {
  const Found found(kepler("[[force]]\ngravity = \"-g*E2\"\n"));
  CHECK(found.names() == std::vector<std::string>{"energy", "angular_momentum.E2"});
}

TEST_CASE("momenta: a chain in free space conserves G and H, with gravity the horizontal part of G only") {
  CHECK(Found(free_chain()).names() ==
        std::vector<std::string>{"energy", "momentum.x", "momentum.y", "angular_momentum.E3"});
  CHECK(Found(free_chain("[[force]]\ngravity = \"-g*E2\"\n")).names() ==
        std::vector<std::string>{"energy", "momentum.x"});
}

TEST_CASE("momenta: a constraint that is invariant under rotation conserves H, any other does not") {
  const std::string circle = "[[constraint]]\nname = \"c\"\nholonomic = \"x^2 + y^2 - m\"\n";
  const std::string ellipse = "[[constraint]]\nname = \"c\"\nholonomic = \"x^2 + 2*y^2 - m\"\n";
  CHECK(Found(kepler(circle)).named("angular_momentum.E3") != nullptr);
  CHECK(Found(kepler(circle)).named("angular_momentum.E1") == nullptr);
  CHECK(Found(kepler(ellipse)).named("angular_momentum.E3") == nullptr);
}

TEST_CASE("momenta: forces without a potential count; a balanced pair conserves the momentum") {
  const std::string drag = "[[force]]\non = \"P\"\nforce = \"-g*velocity(P)\"\n";
  CHECK(Found(kepler(drag)).names().empty());
  const std::string pair = R"toml(
[[force]]
damper = { between = ["P", "link2"], coefficient = "g" }
)toml";
  CHECK(Found(free_chain(pair)).names() == std::vector<std::string>{"momentum.x", "momentum.y", "angular_momentum.E3"});
}

TEST_CASE("momenta: a varying mass without forces conserves m v but not the energy") {
  const Found found(R"toml(format = 1
[parameters]
m0 = 1
b = 0.1
[functions]
m = "m0 + b*t^2"
[[particle]]
name = "P"
mass = "m"
position = { cylindrical = ["r", "theta", "z"] }
)toml");
  CHECK(found.named("energy") == nullptr);
  CHECK(found.named("momentum.theta") != nullptr);
  CHECK(found.named("momentum.z") != nullptr);
  CHECK(found.named("linear_momentum.E1") != nullptr);
  CHECK(found.named("linear_momentum.E3") == nullptr);  // is momentum.z
  CHECK(found.named("angular_momentum.E1") != nullptr);
}
