// SPDX-License-Identifier: GPL-3.0-or-later
// Derived equations against equations from the source or derived by hand; compared by proof, not by text.
#include <doctest/doctest.h>

#include "reading/by_name.hpp"
#include "reading/trig.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::DisplayForm;
using reading::Equation;

namespace {

DisplayForm derive(System& s, system::Approach approach) { return reading::derive_display_form(s.mechanics, approach); }

const Equation& of(const DisplayForm& form, System& s, const std::string& coordinate) {
  for (const Equation& equation : form.equations) {
    if (s.model.coordinates[equation.coordinate].name == coordinate) return equation;
  }
  throw std::logic_error("no equation of " + coordinate);
}

Sum residual(System& s, const Equation& equation) {
  Sum result = equation.expanded - equation.force;
  for (const reading::MultiplierTerm& term : equation.multipliers)
    result -= s.symbol.multiplier(term.constraint) * term.slope;
  return result;
}

}  // namespace

TEST_CASE("P7: approach I gives (2.111), approach II gives (2.109)") {
  System s(model::read_model(shipped("P7_moving_sphere")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const Sum m = v("m"), g = v("g"), D = v("D"), d = v("d"), sn = sin(v("phi")), cs = cos(v("phi"));
  const Sum dphi = v("phi_dot"), dtheta = v("theta_dot");
  for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
    const DisplayForm form = derive(s, approach);
    const Equation& theta = of(form, s, "theta");
    CHECK(theta.momentum == m * d * d * sn * sn * dtheta);
    CHECK(theta.slope.is_zero());
    CHECK(theta.force == D * d * d * sn);
    const Equation& phi = of(form, s, "phi");
    CHECK(phi.momentum == m * d * d * dphi);
    CHECK(same(phi.slope, m * d * d * sn * cs * square(dtheta) + m * g * d * sn));
    CHECK(phi.force.is_zero());
    CHECK(theta.of_motion);
    CHECK(phi.multipliers.empty());
  }
  const DisplayForm one = derive(s, system::Approach::one);
  CHECK(one.equations.size() == 3);
  CHECK(derive(s, system::Approach::two).equations.size() == 2);
  const Equation& R = of(one, s, "R");
  CHECK_FALSE(R.of_motion);
  CHECK(R.momentum == m * v("d_dot"));
  CHECK(same(R.slope, m * d * square(sn) * square(dtheta) + m * d * square(dphi) - m * g * cs));
  REQUIRE(R.multipliers.size() == 1);
  CHECK(R.multipliers[0].slope == Sum(1));
  REQUIRE(one.reactions.size() == 1);
  REQUIRE(one.reactions[0].value);
  CHECK(same(*one.reactions[0].value,
             m * v("d_ddot") - m * d * (square(sn) * square(dtheta) + square(dphi)) + m * g * cs));
}

TEST_CASE("P7: energies are (2.105) and (2.106)") {
  System s(model::read_model(shipped("P7_moving_sphere")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const Sum sn = sin(v("phi"));
  const DisplayForm one = derive(s, system::Approach::one), two = derive(s, system::Approach::two);
  CHECK(same(one.kinetic, half(v("m")) * (square(v("R_dot")) + square(v("R") * sn * v("theta_dot")) +
                                          square(v("R") * v("phi_dot")))));
  CHECK(same(one.potential, v("m") * v("g") * v("R") * cos(v("phi"))));
  CHECK(same(two.kinetic, half(v("m")) * (square(v("d_dot")) + square(v("d") * sn * v("theta_dot")) +
                                          square(v("d") * v("phi_dot")))));
  CHECK(same(two.potential, v("m") * v("g") * v("d") * cos(v("phi"))));
}

TEST_CASE("constrained kinetic energies: T2 + T1 + T0 is T, and T1, T0 come from moving constraints only") {
  for (const char* name : {"P7_moving_sphere", "P1_spherical_pendulum", "P1_spherical_pendulum_varying",
                           "P2_planar_pendulum_varying", "S5_double_pendulum", "S1_two_masses", "cart_pendulum"}) {
    CAPTURE(name);
    System s(model::read_model(shipped(name)));
    const DisplayForm form = derive(s, system::Approach::two);
    REQUIRE(form.by_degree);
    const auto& [T2, T1, T0] = *form.by_degree;
    CHECK(T2 + T1 + T0 == form.kinetic);
    if (s.model.functions.empty()) {
      CHECK(T1.is_zero());
      CHECK(T0.is_zero());
    } else {
      CHECK_FALSE(T0.is_zero());
    }
  }
}

TEST_CASE("approach I and approach II give the same motion") {
  for (const char* name :
       {"P1_spherical_pendulum", "P1_spherical_pendulum_varying", "P2_planar_pendulum", "P2_planar_pendulum_varying",
        "P7_moving_sphere", "S5_double_pendulum", "S5_spherical_double_pendulum", "S5_double_pendulum_cartesian"}) {
    CAPTURE(name);
    System s(model::read_model(shipped(name)));
    const DisplayForm one = derive(s, system::Approach::one), two = derive(s, system::Approach::two);
    for (const Equation& equation : two.equations) {
      const Equation& other = of(one, s, s.model.coordinates[equation.coordinate].name);
      CHECK(other.of_motion);
      CHECK(same(residual(s, equation), residual(s, other)));
    }
  }
}

TEST_CASE("P1: the tension of the rod is -lambda") {
  System s(model::read_model(shipped("P1_spherical_pendulum")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const DisplayForm form = derive(s, system::Approach::one);
  REQUIRE(form.reactions.size() == 1);
  // along the rod: weight component towards the centre and centripetal force
  const Sum tension = v("m") * v("L") * (square(v("phi_dot")) + square(sin(v("phi")) * v("theta_dot"))) -
                      v("m") * v("g") * cos(v("phi"));
  CHECK(same(*form.reactions[0].value, -tension));
}

TEST_CASE("P2: both constraint forces of a pendulum of varying length") {
  System s(model::read_model(shipped("P2_planar_pendulum_varying")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const DisplayForm form = derive(s, system::Approach::one);
  REQUIRE(form.reactions.size() == 2);
  CHECK(same(*form.reactions[0].value,
             v("m") * v("L_ddot") - v("m") * v("L") * square(v("theta_dot")) - v("m") * v("g") * cos(v("theta"))));
  CHECK(form.reactions[1].value->is_zero());  // no force out of the plane
}

TEST_CASE("S5: the planar double pendulum and the forces along its rods") {
  System s(model::read_model(shipped("S5_double_pendulum")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const Sum m1 = v("m1"), m2 = v("m2"), L1 = v("L1"), L2 = v("L2"), g = v("g"), t1 = v("theta1"), t2 = v("theta2");
  const Sum w1 = square(v("theta1_dot")), w2 = square(v("theta2_dot"));
  const DisplayForm form = derive(s, system::Approach::one);
  CHECK(same(residual(s, of(form, s, "theta1")),
             (m1 + m2) * L1 * L1 * v("theta1_ddot") +
                 m2 * L1 * L2 * (cos(t1 - t2) * v("theta2_ddot") + sin(t1 - t2) * w2) + (m1 + m2) * g * L1 * sin(t1)));
  CHECK(same(residual(s, of(form, s, "theta2")),
             m2 * L2 * L2 * v("theta2_ddot") + m2 * L1 * L2 * (cos(t1 - t2) * v("theta1_ddot") - sin(t1 - t2) * w1) +
                 m2 * g * L2 * sin(t2)));
  REQUIRE(form.reactions.size() == 2);
  // Newton for the second mass along its rod: acceleration of both masses, weight
  CHECK(same(*form.reactions[1].value,
             -m2 * (L2 * w2 + L1 * cos(t1 - t2) * w1 + L1 * sin(t1 - t2) * v("theta1_ddot")) - m2 * g * cos(t2)));
}

TEST_CASE("S5 in Cartesian coordinates: constraints keep their multipliers and two time derivatives") {
  System s(model::read_model(shipped("S5_double_pendulum_cartesian")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const DisplayForm form = derive(s, system::Approach::two);
  REQUIRE(form.constraints.size() == 2);
  CHECK_FALSE(form.constraints[0].fixes);
  CHECK(same(form.constraints[0].rate, v("x1") * v("x1_dot") + v("y1") * v("y1_dot")));
  CHECK(same(form.constraints[0].acceleration,
             v("x1") * v("x1_ddot") + v("y1") * v("y1_ddot") + square(v("x1_dot")) + square(v("y1_dot"))));
  CHECK(same(residual(s, of(form, s, "x2")),
             v("m2") * v("x2_ddot") - v("m2") * v("g") - s.symbol.multiplier(1) * (v("x2") - v("x1"))));
}

TEST_CASE("pure energies: cart and pendulum with an input") {
  System s(model::read_model(shipped("cart_pendulum")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const DisplayForm form = derive(s, system::Approach::two);
  CHECK(same(residual(s, of(form, s, "x")),
             (v("M") + v("m")) * v("x_ddot") +
                 v("m") * v("l") * (cos(v("theta")) * v("theta_ddot") - sin(v("theta")) * square(v("theta_dot"))) -
                 v("F") + v("c") * v("x_dot")));
}

TEST_CASE("a particle of varying mass: d(mv)/dt = F, eq. (2.163)") {
  System s(model::read_model_text(R"(format = 1
[parameters]
m0 = 3
k = 0.1
c = 2
[functions]
m = "m0 - k*t"
[coordinates]
x = {}
[[particle]]
name = "P"
mass = "m"
position = "x*E1"
[[force]]
on = "P"
force = "-c*x_dot*E1"
)",
                                  "rocket"));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const DisplayForm form = derive(s, system::Approach::one);
  CHECK(same(residual(s, of(form, s, "x")), v("m") * v("x_ddot") + v("m_dot") * v("x_dot") + v("c") * v("x_dot")));
}

TEST_CASE("a coordinate fixed through another one: its multiplier enters both equations") {
  System s(model::read_model_text(R"(format = 1
[parameters]
m = 2
[functions]
d = "1 + t^2"
[coordinates]
x = {}
y = {}
z = {}
[[particle]]
name = "P"
mass = "m"
position = "x*E1 + y*E2 + z*E3"
[[constraint]]
name = "first"
holonomic = "x - d"
[[constraint]]
name = "second"
holonomic = "y - 3*x"
)",
                                  "chain of constraints"));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const DisplayForm form = derive(s, system::Approach::one);
  REQUIRE(form.reactions.size() == 2);
  CHECK(same(*form.reactions[1].value, Sum(3) * v("m") * v("d_ddot")));
  CHECK(same(*form.reactions[0].value, Sum(10) * v("m") * v("d_ddot")));  // m x_ddot = lambda1 - 3 lambda2
}
