// SPDX-License-Identifier: GPL-3.0-or-later
// Models that each test special features of the model language: reader, mechanics and every formulation against the
// oracle.
#include <doctest/doctest.h>

#include <string>

#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

void check_passes(const std::string& text) {
  const model::Model model = model::read_model_text("format = 1\n" + text, "feature.toml");
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  const verify::Certificate c = verify::verify(mechanics, {50, 6, 1});
  CHECK(c.pass);
  INFO(c.summary());
  for (const verify::Comparison& row : c.comparisons) {
    CAPTURE(row.a);
    CAPTURE(row.b);
    CAPTURE(row.max_relative_difference);
    CHECK(row.digits_agreed >= 45);
  }
}

}  // namespace

TEST_CASE("features: rocket of mass m(t) with drag in a central field, by [functions] that depend on one another") {
  check_passes(R"toml(
[parameters]
m0 = 2
GM = 3
k = 0.1
[functions]
burn = "k*t"
m = "m0 - m0*burn/20 + burn*sin(burn)/10"
[[particle]]
name = "P"
mass = "m"
position = { spherical = ["R", "phi", "theta"] }
[[force]]
central_gravity = { GM = "GM" }
[[force]]
drag = { on = "P", density = "1.2", area = "0.01", coefficient = "0.4" }
[[force]]
on = "P"
force = "m_dot*unit(velocity(P))*3"
[scene.default]
t = [0, 5]
initial = { R = 2, phi = 1, R_dot = 0.2, theta_dot = 0.7 }
)toml");
}

TEST_CASE("features: charts relative to one another, dampers, springs with an energy, mutual attraction") {
  check_passes(R"toml(
[parameters]
m1 = 1
m2 = 2
A = 3
B = 0.5
L0 = 0.4
[[particle]]
name = "P"
mass = "m1"
position = { cylindrical = ["r", "alpha", "z"] }
[[particle]]
name = "Q"
mass = "m2"
position = { spherical = ["R", "phi", "theta"], from = "P" }
[[point]]
name = "hook"
position = "2*A*E1 + A*sin(B*t)*E3"
[[force]]
gravitation = { G = "0.7" }
[[force]]
spring = { between = ["hook", "Q"], energy = "A*extension^2 + B*extension^4" }
[[force]]
spring = { between = ["P", "Q"], stiffness = "4", length = "L0" }
[[force]]
damper = { between = ["P", "hook"], coefficient = "0.3*(1 + B*r^2)" }
[[force]]
on = "Q"
force = "A*P.e_alpha + 2*A*Q.e_theta - B*velocity(Q)*norm(velocity(Q)) + B*Q.g_phi + A*cross(E3, velocity(P))"
[[force]]
gravity = "-9.81*E3"
[scene.default]
initial = { r = 1, R = 1.5, phi = 1, z = 0.3 }
)toml");
}

TEST_CASE("features: coordinates in vector expressions alone, with forces along their bases") {
  check_passes(R"toml(
[parameters]
m = 1
k = 1
[coordinates]
u = {}
v = {}
theta = {}
a = {}
b = {}
c = { range = [0, 2] }
[[particle]]
name = "A"
mass = "m"
position = "u*v*cos(theta)*E1 + u*v*sin(theta)*E2 + (u^2 - v^2)/2*E3"
[[particle]]
name = "D"
mass = "m/2"
position = ["a*cosh(b)", "a*sinh(b) + c^2/9", "k*c + a"]
[[particle]]
name = "C"
mass = "2*m"
position = { cylindrical = ["r", "2*theta", "0.3*r*theta + a"] }
[[force]]
on = "A"
force = "k*A.a_u - v*A.a_v + k*A.e_theta"
[[force]]
on = "D"
force = "k*D.a_a + k*D.e_b*c_dot - k*D.a_c*exp(-a^2) + k*C.a_r"
[[force]]
gravity = "-9.81*E3"
[scene.default]
initial = { u = 1, v = 1.3, a = 1, b = 0.3, c = 0.5, r = 1 }
)toml");
}

TEST_CASE("features: kinks, if, atan2, inputs, torsion, ddt and diff within forces") {
  check_passes(R"toml(
[parameters]
m = 1
k = 2
c = 0
n = 1
[inputs]
u = { default = 0.5 }
[definitions]
speed = "norm(velocity(P))"
T = "m/2*dot(velocity(P), velocity(P))"
[[particle]]
name = "P"
mass = "m"
position = { cylindrical = ["r", "theta"] }
[[force]]
generalized = { r = "k*if(n*r < 1, sin(n*r), sin(1) + cos(1)*(n*r - 1)) + k*max(u, n*r)*min(n*r, 2) - n*abs(r_dot)*r_dot", theta = "-sign(theta_dot)*k + k*atan2(n*r, theta)" }
[[force]]
torsion = { angle = "theta + n*r^2/3", stiffness = "k", rest = "c*t", coefficient = "0.1" }
[[force]]
on = "P"
force = "(n*diff(T, r_dot) - k*diff(T, theta)/r)*E1 + (k*ddt(r*theta) + c)*E2*tanh(n*speed)"
[scene.default]
initial = { r = 1.2, theta = 0.4, theta_dot = 0.5 }
)toml");
}

TEST_CASE("features: constraints of curves and of moving surfaces, some eliminated and some with multipliers") {
  check_passes(R"toml(
[parameters]
m = 1
a = 0.5
b = 0.2
w = 3
n = 1
[functions]
h = "1 + b*cos(w*t)"
[[particle]]
name = "P"
mass = "m"
position = { cylindrical = ["r", "theta", "z"] }
[[particle]]
name = "Q"
mass = "2*m"
position = { cartesian = ["x", "y", "s"] }
[[force]]
gravity = "-9.81*E3"
[[constraint]]
name = "height"
holonomic = "2*z - h*a*n"
[[constraint]]
name = "after"
holonomic = "s - n*z^2 - b*t/10"
[[constraint]]
name = "rod"
holonomic = "n*dot(Q - P, Q - P) - 4*n^2"
[[constraint]]
name = "curve"
holonomic = ["n*x^2 + n*y^2 - 1 - sin(w*t)/10 - n*s/20"]
[scene.default]
initial = { r = 1.5, x = 1 }
guess = { y = 0.5 }
)toml");
}

TEST_CASE("features: energies added to particles, moving frames of reference with T1 and T0") {
  check_passes(R"toml(
[parameters]
m = 1
J = 0.3
W = 2
l = 0.7
[coordinates]
phi = "rad"
psi = "rad"
[[particle]]
name = "P"
mass = "m"
position = "l*(sin(phi)*cos(W*t)*E1 + sin(phi)*sin(W*t)*E2 - cos(phi)*E3)"
[energy]
kinetic = "J/2*(psi_dot + W*cos(phi))^2 + m*W*t*phi_dot*sin(psi) + J*psi_dot^4/12"
potential = "m*9.81*l*cos(psi - phi)*exp(-W*t/9)"
[[force]]
gravity = "-9.81*E3*(1 + W*t/50)"
)toml");
}

TEST_CASE(
    "features: constraints on velocities: a vector, a list, moving ones, with holonomic ones that keep multipliers") {
  check_passes(R"toml(
[parameters]
m = 2
L = 1.5
v = 0.3
[functions]
slope = "v*sin(2*t) + 1"
[[particle]]
name = "P"
mass = "m"
position = { cylindrical = ["r", "alpha", "z"] }
[[particle]]
name = "Q"
mass = "m/(2 + t)"
position = { spherical = ["R", "phi", "theta"], from = "P" }
[[particle]]
name = "S"
mass = "3"
position = { cartesian = ["x1", "x2", "x3"] }
[[force]]
gravity = "-9.81*E3"
[[constraint]]
name = "rod"
holonomic = "dot(Q, Q) - 4*L^2*(1 + t/9)"
[[constraint]]
name = "chase"
velocity = ["r_dot + slope*z_dot*alpha - v", "dot(velocity(Q), P.e_alpha) + slope_dot*R"]
[[constraint]]
name = "tow"
velocity = "velocity(S) - cross(E3 + t*E1, velocity(P)) + v*E2"
[[constraint]]
name = "stay"
holonomic = "R - L*sqrt(1 + t/9)"
[scene.default]
t = [0, 2]
initial = { r = 2, phi = 1, alpha = 0.4 }
)toml");
}

TEST_CASE("features: parameters that depend on later ones in the file, over several steps") {
  check_passes(R"toml(
[parameters]
k = "2*c/m"
c = "b*b"
b = 3
m = 0.5
[coordinates]
x = {}
[energy]
kinetic = "m/2*x_dot^2"
potential = "k*x^2/2"
)toml");
}

// A mass above the roots of binary64, whose inverse is below its range, in a prescribed motion.
TEST_CASE("features: a mass of 1e300 that is moved by constraints") {
  check_passes(R"toml(
[parameters]
m0 = "1e300"
[functions]
m = "m0 - 8*t"
climb = "10*t^2 + 6378"
[[particle]]
name = "P"
mass = "m"
position = { spherical = ["R", "phi", "theta"] }
[[force]]
central_gravity = { GM = 3 }
[[constraint]]
name = "radial"
holonomic = "R - climb"
[[constraint]]
name = "meridian"
holonomic = "theta - 0.3"
[scene.default]
t = [0, 5]
initial = { phi = 1.1 }
)toml");
}
