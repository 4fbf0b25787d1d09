// SPDX-License-Identifier: GPL-3.0-or-later
// Each formulation and approach against equations of motion derived by hand.
#include "derive/formulations.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "support/numbers.hpp"
#include "support/particles.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;

namespace {

// Sums of a few dozen terms of order 1 to 100 in binary64.
constexpr double rounding = 1e-12;

std::string named(const system::EquationSystem& system) {
  return system.formulation + " " + system::name(system.approach);
}

void for_each_formulation(const model::Model& model,
                          const std::function<void(mechanics::Mechanics&, const system::EquationSystem&)>& check) {
  for (const derive::FormulationEntry& formulation : derive::formulations()) {
    for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
      mechanics::Mechanics m = mechanics::build_mechanics(model);
      const std::optional<system::EquationSystem> system = formulation.derive(m, approach);
      if (!system) continue;
      INFO(formulation.name, " ", system::name(approach));
      check(m, *system);
    }
  }
}

}  // namespace

TEST_CASE("formulations: P7 has the equation of motion (2.109) and the reaction (2.111)") {
  const model::Model model = model::read_model_text(R"toml(format = 1
[parameters]
m = 2
g = 9.81
D = 0.3
d0 = 1
a = 0.1
w = 2
[functions]
d = "d0 + a*sin(w*t)"
)toml" + test::particle_in_space + R"toml([[force]]
on = "P"
force = "D*R*P.e_theta"
[[constraint]]
name = "sphere"
holonomic = "R - d"
)toml",
                                                    "P7");
  const double m = 2, g = 9.81, D = 0.3, phi = 1.1, dphi = -0.4, dtheta = 1.7, t = 0.3;
  const double d = 1 + 0.1 * std::sin(2 * t), d1 = 0.2 * std::cos(2 * t), d2 = -0.4 * std::sin(2 * t);
  const double s = std::sin(phi), c = std::cos(phi);
  const double theta_ddot =
      (D * s / m * d * d - 2 * d * d1 * s * s * dtheta - 2 * d * d * s * c * dphi * dtheta) / (d * d * s * s);
  const double phi_ddot = (m * d * d * s * c * dtheta * dtheta + m * g * d * s - 2 * m * d * d1 * dphi) / (m * d * d);
  const double lambda = m * d2 - m * d * s * s * dtheta * dtheta - m * d * dphi * dphi + m * g * c;
  std::set<std::string> systems;
  for_each_formulation(model, [&](mechanics::Mechanics& mechanics, const system::EquationSystem& system) {
    test::Point point(mechanics, {{"t", t},
                                  {"m", m},
                                  {"g", g},
                                  {"D", D},
                                  {"d0", 1},
                                  {"a", 0.1},
                                  {"w", 2},
                                  {"phi", phi},
                                  {"phi_dot", dphi},
                                  {"theta", 0.7},
                                  {"theta_dot", dtheta}});
    REQUIRE(system.free.size() == 2);
    REQUIRE(system.active.empty());
    point.solve(system);
    CHECK(point.at("theta_ddot") == doctest::Approx(theta_ddot).epsilon(rounding));
    CHECK(point.at("phi_ddot") == doctest::Approx(phi_ddot).epsilon(rounding));
    CHECK(point.reaction(system, "sphere") == doctest::Approx(lambda).epsilon(rounding));
    CHECK(point.output(system, "R") == doctest::Approx(d).epsilon(rounding));
    CHECK(point.output(system, "R_dot") == doctest::Approx(d1).epsilon(rounding));
    // P_nc + lambda ddot: the force D R e_theta and the moving sphere
    CHECK(point.output(system, "power") == doctest::Approx(D * d * d * s * dtheta + lambda * d1).epsilon(rounding));
    systems.insert(named(system));
  });
  // Trees have constraints imposed: one approach only.
  for (const char* name : {"lagrange I", "lagrange II", "jacobian I", "jacobian II", "recursive II", "articulated II",
                           "christoffel I", "christoffel II", "expanded I", "expanded II"})
    CHECK_MESSAGE(systems.contains(name), name);
}

TEST_CASE("formulations: the cart and pendulum from its energies, with an input and friction on the cart") {
  const model::Model model = model::read_model_text(R"toml(format = 1
[parameters]
M = 2
m = 0.5
l = 0.8
g = 9.81
c = 0.1
[inputs]
F = { default = 0 }
[coordinates]
x = {}
theta = {}
[energy]
kinetic = "(M + m)/2*x_dot^2 + m*l*x_dot*theta_dot*cos(theta) + m*l^2/2*theta_dot^2"
potential = "-m*g*l*cos(theta)"
[[force]]
generalized = { x = "F - c*x_dot" }
)toml",
                                                    "cart");
  const double M = 2, m = 0.5, l = 0.8, g = 9.81, c = 0.1, F = 3, v = 0.4, th = 0.9, w = -1.2;
  // Solved by hand for the accelerations.
  const double right_x = F - c * v + m * l * w * w * std::sin(th), right_th = -m * g * l * std::sin(th);
  const double coupling = m * l * std::cos(th), det = (M + m) * m * l * l - coupling * coupling;
  const double x_ddot = (right_x * m * l * l - coupling * right_th) / det;
  const double theta_ddot = ((M + m) * right_th - coupling * right_x) / det;
  std::set<std::string> systems;
  for_each_formulation(model, [&](mechanics::Mechanics& mechanics, const system::EquationSystem& system) {
    test::Point point(mechanics, {{"t", 0},
                                  {"M", M},
                                  {"m", m},
                                  {"l", l},
                                  {"g", g},
                                  {"c", c},
                                  {"F", F},
                                  {"x", 0.2},
                                  {"x_dot", v},
                                  {"theta", th},
                                  {"theta_dot", w}});
    point.solve(system);
    CHECK(point.at("x_ddot") == doctest::Approx(x_ddot).epsilon(rounding));
    CHECK(point.at("theta_ddot") == doctest::Approx(theta_ddot).epsilon(rounding));
    CHECK(point.output(system, "power") == doctest::Approx((F - c * v) * v).epsilon(rounding));
    systems.insert(named(system));
  });
  // The jacobian formulation and trees need masses.
  for (const char* name : {"lagrange I", "lagrange II", "christoffel I", "christoffel II", "expanded I", "expanded II"})
    CHECK_MESSAGE(systems.contains(name), name);
  for (const std::string& name : systems) {
    for (const char* formulation : {"jacobian", "recursive", "articulated"})
      CHECK_FALSE_MESSAGE(name.starts_with(formulation), name);
  }
}

TEST_CASE("formulations: a rod between a particle and the origin as a quadratic constraint keeps its multiplier") {
  const model::Model model = model::read_model_text(R"toml(format = 1
[parameters]
m = 1.5
g = 9.81
L = 2
)toml" + test::particle_in_plane + R"toml([[constraint]]
name = "rod"
holonomic = "x^2 + y^2 - L^2"
)toml",
                                                    "rod");
  const double m = 1.5, g = 9.81, L = 2, th = 0.6, w = 1.3;
  const double x = L * std::sin(th), y = -L * std::cos(th), vx = L * w * std::cos(th), vy = L * w * std::sin(th);
  // Planar pendulum: the rod pulls with N = m L w^2 + m g cos(th) towards the origin; lambda grad psi = 2 lambda r.
  const double lambda = -(m * L * w * w + m * g * std::cos(th)) / (2 * L);
  const double a_t = -g * std::sin(th);
  for_each_formulation(model, [&](mechanics::Mechanics& mechanics, const system::EquationSystem& system) {
    REQUIRE(system.active.size() == 1);
    test::Point point(mechanics,
                      {{"t", 0}, {"m", m}, {"g", g}, {"L", L}, {"x", x}, {"y", y}, {"x_dot", vx}, {"y_dot", vy}});
    point.solve(system);
    CHECK(point.at("lambda.rod") == doctest::Approx(lambda).epsilon(rounding));
    CHECK(point.reaction(system, "rod") == doctest::Approx(lambda).epsilon(rounding));
    CHECK(point.at("x_ddot") == doctest::Approx(a_t * std::cos(th) - L * w * w * std::sin(th)).epsilon(rounding));
    CHECK(point.at("y_ddot") == doctest::Approx(a_t * std::sin(th) + L * w * w * std::cos(th)).epsilon(rounding));
  });
}

TEST_CASE("formulations: a growing mass and a prescribed position satisfy the power balance") {
  // dE/dt from the energy itself, differentiated along the derived motion.
  const model::Model model = model::read_model_text(R"toml(format = 1
[parameters]
m0 = 1
k = 3
[functions]
m = "m0 + t/5"
d = "sin(2*t)"
[[particle]]
name = "P"
mass = "m"
position = "x*E1 + d*x*E2 + d*E3"
[[force]]
spring = { between = ["P", "origin"], stiffness = "k", length = 1 }
[[force]]
on = "P"
force = "-x_dot*E1 + E3"
[coordinates]
x = {}
)toml",
                                                    "power");
  for_each_formulation(model, [&](mechanics::Mechanics& mechanics, const system::EquationSystem& system) {
    test::Point point(mechanics, {{"t", 0.4}, {"m0", 1}, {"k", 3}, {"x", 0.8}, {"x_dot", -0.5}});
    point.solve(system);
    symbolic::Derivation ddt = symbolic::total_time_derivative(*mechanics.dag, mechanics.q.size(), 2);
    CHECK(point.evaluate(ddt(system.energy)) == doctest::Approx(point.evaluate(system.power)).epsilon(rounding));
  });
}

TEST_CASE("formulations: an armature a adds a qddot to the force on its coordinate, and keeps trees of bodies") {
  const std::string arm = R"toml(format = 1
[parameters]
m = 2
g = 9.81
L = 0.7
J = 0.3
a1 = 0.11
a2 = 0.23
[[body]]
name = "b1"
mass = "m"
inertia = { principal = ["J", "J/2", "2*J/3"] }
position = "L*b1.e1"
rotation = { axis = "E2", angle = "q1" }
[[body]]
name = "b2"
mass = "m"
inertia = { principal = ["2*J/3", "J/2", "J"] }
position = "2*L*b1.e1 + L*b2.e1"
rotation = { axis = "b1.e3", angle = "q2" }
relative_to = "b1"
[[force]]
gravity = "-g*E3"
)toml";
  const auto accelerations = [](const std::string& text) {
    std::map<std::string, std::array<double, 2>> found;
    for_each_formulation(model::read_model_text(text, "arm"),
                         [&](mechanics::Mechanics& mechanics, const system::EquationSystem& system) {
                           test::Point point(mechanics, {{"m", 2},
                                                         {"g", 9.81},
                                                         {"L", 0.7},
                                                         {"J", 0.3},
                                                         {"a1", 0.11},
                                                         {"a2", 0.23},
                                                         {"q1", 0.4},
                                                         {"q1_dot", 1.3},
                                                         {"q2", -0.8},
                                                         {"q2_dot", 0.6}});
                           point.solve(system);
                           found[named(system)] = {point.at("q1_ddot"), point.at("q2_ddot")};
                         });
    return found;
  };
  const std::string by_key = "[coordinates]\nq1 = { armature = \"a1\" }\nq2 = { armature = \"a2\" }\n";
  const std::string by_energy = "[energy]\nkinetic = \"a1*q1_dot^2/2 + a2/2*q2_dot^2\"\n";
  const auto bare = accelerations(arm);
  for (const std::string& rotors : {by_key, by_energy, by_key + "[energy]\nkinetic = \"J*q1_dot^2 - q1_dot^2*J\"\n"}) {
    const auto found = accelerations(arm + rotors);
    REQUIRE(found.contains("lagrange I"));
    for (const char* name : {"recursive II", "articulated II"}) CHECK_MESSAGE(found.contains(name), name);
    const std::array<double, 2> expected = found.at("lagrange I");
    CHECK(std::abs(expected[0] - bare.at("lagrange I")[0]) > 0.01);
    for (const auto& [name, value] : found) {
      CHECK_MESSAGE(value[0] == doctest::Approx(expected[0]).epsilon(rounding), name);
      CHECK_MESSAGE(value[1] == doctest::Approx(expected[1]).epsilon(rounding), name);
    }
  }
  // A product of two rates belongs to no single joint.
  const auto mixed = accelerations(arm + "[energy]\nkinetic = \"a1*q1_dot*q2_dot\"\n");
  CHECK(mixed.contains("lagrange I"));
  CHECK_FALSE(mixed.contains("recursive II"));
}
