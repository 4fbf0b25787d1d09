// SPDX-License-Identifier: GPL-3.0-or-later
#include "conservation/conserved.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "conservation/zero_parameters.hpp"
#include "derive/formulations/lagrange.hpp"
#include "support/particles.hpp"

using namespace eomgen;

namespace {

std::vector<std::string> names(const std::string& text) {
  const model::Model model = model::read_model_text(text, "conserved");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  system::EquationSystem s = derive::lagrange(m, system::Approach::two);
  std::vector<std::string> result;
  for (const conservation::ConservedQuantity& c : conservation::conserved_quantities(m, s)) result.push_back(c.name);
  return result;
}

const std::string spherical_pendulum = R"toml(format = 1
[parameters]
m = 1
g = 9.81
L0 = 1
[functions]
L = "L0 LENGTH"
)toml" + test::particle_in_space + R"toml([[constraint]]
name = "rod"
holonomic = "R - L"
)toml";

std::string with(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("conserved: a spherical pendulum of constant length conserves its energy and h_z") {
  CHECK(names(with(spherical_pendulum, " LENGTH", "")) == std::vector<std::string>{"energy", "momentum.theta"});
}

TEST_CASE("conserved: a spherical pendulum of varying length conserves h_z only") {
  CHECK(names(with(spherical_pendulum, " LENGTH", " + sin(t)/5")) == std::vector<std::string>{"momentum.theta"});
}

TEST_CASE("conserved: a bead on a hoop that turns at a constant rate conserves the Jacobi integral, not the energy") {
  const std::vector<std::string> found = names(R"toml(format = 1
[parameters]
m = 1
g = 9.81
L = 1
W = 3
)toml" + test::particle_in_space + R"toml([[constraint]]
name = "hoop"
holonomic = "R - L"
[[constraint]]
name = "turn"
holonomic = "theta - W*t"
)toml");
  CHECK(found == std::vector<std::string>{"jacobi"});
}

TEST_CASE("conserved: of a top with a spring and a moment that are 0, each quantity names the parameters it needs") {
  using Needs = std::map<std::string, std::vector<std::string>>;
  const auto needs = [](const std::string& moment) {
    const model::Model model = model::read_model_text(with(R"toml(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "0.1 m"
J = "1 kg*m^2"
K = { value = 0, unit = "N*m/rad" }
G = { value = MOMENT, unit = "N*m" }
[[body]]
name = "top"
mass = "m"
inertia = { principal = ["J", "J", "2*J"] }
position = "L*top.e3"
rotation = { euler = "313", angles = ["psi", "theta", "phi"] }
[[force]]
gravity = "-g*E3"
[[force]]
torsion = { angle = "psi", stiffness = "K" }
[[force]]
moment = "G*E3"
on = "top"
)toml",
                                                           "MOMENT", moment),
                                                      "top");
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    system::EquationSystem s = derive::lagrange(m, system::Approach::two);
    const auto known = conservation::conserved_quantities(m, s);
    Needs result;
    for (const conservation::ConservedQuantity& c : conservation::conserved_where_zero(m, s, known)) {
      for (const std::uint32_t p : c.zero_parameters) result[c.name].push_back(m.model->parameters[p].name);
    }
    return result;
  };
  CHECK(needs("0") == Needs{{"energy", {"G"}}, {"momentum.phi", {"G"}}, {"momentum.psi", {"K", "G"}}});
  CHECK(needs("1").empty());
}

TEST_CASE("conserved: with a damper nothing is conserved") {
  const std::vector<std::string> found = names(R"toml(format = 1
[parameters]
m = 1
c = 1
[[particle]]
name = "P"
mass = "m"
position = "x*E1"
[[force]]
on = "P"
force = "-c*x_dot*E1"
[coordinates]
x = {}
)toml");
  CHECK(found.empty());
}

TEST_CASE("conserved: a quantity that jumps in time or space is not conserved, though its derivatives vanish") {
  const auto with_potential = [](const std::string& potential) {
    return names(
        "format = 1\n[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = \"(x_dot^2 + y_dot^2)/2\"\npotential = \"" +
        potential + "\"\n");
  };
  CHECK(with_potential("y*sign(t - 2)") == std::vector<std::string>{"momentum.x"});
  CHECK(with_potential("y*if(x > 1, 1, 2)") == std::vector<std::string>{"energy"});
  CHECK(with_potential("if(x - y > 1, 1, 2)") == std::vector<std::string>{"energy"});
  CHECK(with_potential("y*if(y > 1, 1, 2)") == std::vector<std::string>{"energy", "momentum.x"});
  CHECK(with_potential("abs(y)") == std::vector<std::string>{"energy", "momentum.x"});
}

TEST_CASE("conserved: total momenta are conserved across a jump that depends only on a distance") {
  const auto pair = [](const std::string& condition) {
    return names(
        "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\"] "
        "}\n[[particle]]\nname = \"Q\"\nmass = 2\n"
        "position = { cartesian = [\"u\", \"v\"] }\n[energy]\npotential = \"if(" +
        condition + ", 1, 3)\"\n");
  };
  const auto has = [](const std::vector<std::string>& found, const std::string& name) {
    return std::find(found.begin(), found.end(), name) != found.end();
  };
  const std::vector<std::string> between = pair("norm(P - Q) < 1"), fixed = pair("x < 1");
  for (const char* name : {"linear_momentum.E1", "linear_momentum.E2", "angular_momentum.E3"}) {
    CHECK_MESSAGE(has(between, name), name);
  }
  CHECK_FALSE(has(fixed, "linear_momentum.E1"));
  CHECK(has(fixed, "linear_momentum.E2"));
  CHECK_FALSE(has(fixed, "angular_momentum.E3"));
}

TEST_CASE("conserved: a narrow, distant or faint bump is detected as not constant") {
  for (const char* potential : {"exp(-((x - 30)/0.01)^2)", "1e-40*x"}) {
    CAPTURE(potential);
    const std::vector<std::string> found =
        names(std::string("format = 1\n[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = \"(x_dot^2 + "
                          "y_dot^2)/2\"\npotential = \"") +
              potential + "\"\n");
    CHECK(found == std::vector<std::string>{"energy", "momentum.y"});
  }
}
