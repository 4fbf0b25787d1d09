// SPDX-License-Identifier: GPL-3.0-or-later
// Forces against closed forms, and against Newton's and Euler's equations written by hand in the model.
#include <doctest/doctest.h>

#include <cmath>

#include "support/run_text.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

FinishedRun run_tight(const std::string& name, const std::string& sections) {
  return run_text(name, sections, [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  });
}

// Runs of a second or two at 1e-12, with motions and forces of the order of 1 to 10.
constexpr double same = 1e-9;

const std::string particle_on_a_line = R"toml(
[parameters]
m = "2 kg"
k = "50 N/m"
c = "3 N*s/m"
L = "0.5 m"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", 0, 0] }
)toml";

}  // namespace

TEST_CASE("spring_damper: a mass on a line oscillates with exp(-c t/(2 m)), about the free length") {
  const FinishedRun run = run_tight("spring_damper_line", particle_on_a_line + R"toml([[force]]
spring_damper = { between = ["origin", "P"], stiffness = "k", length = "L", coefficient = "c" }
[scene.default]
t = [0, 2]
initial = { x = 0.7, x_dot = 0 }
)toml");
  const double m = 2, k = 50, c = 3, decay = c / (2 * m), w = std::sqrt(k / m - decay * decay), t = 2;
  const double x = 0.5 + 0.2 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
  CHECK(std::abs(run.final("x") - x) < same);
  CHECK(run.simulation.certificate.pass);
}

TEST_CASE("spring_damper: the motion is that of a spring and a damper, in a plane and if the ends may coincide") {
  const std::string plane = R"toml(
[[particle]]
name = "P"
mass = "2 kg"
position = { cartesian = ["x", "y"] }
[scene.default]
t = [0, 1]
initial = { x = 0.7, y = 0.1, y_dot = 1 }
)toml";
  for (const std::string length : {", length = \"0.5 m\"", ""}) {
    CAPTURE(length);
    const std::string ends = "between = [\"origin\", \"P\"]";
    const FinishedRun one =
        run_tight("spring_damper_one", plane + "[[force]]\nspring_damper = { " + ends + length +
                                           ", stiffness = \"50 N/m\", coefficient = \"3 N*s/m\" }\n");
    const FinishedRun two = run_tight("spring_damper_two", plane + "[[force]]\nspring = { " + ends + length +
                                                               ", stiffness = \"50 N/m\" }\n[[force]]\ndamper = { " +
                                                               ends + ", coefficient = \"3 N*s/m\" }\n");
    CHECK(one.simulation.certificate.pass);
    CHECK(std::abs(one.final("x") - two.final("x")) < same);
    CHECK(std::abs(one.final("y") - two.final("y")) < same);
    CHECK(std::abs(one.final("energy") - two.final("energy")) < same);
  }
}

TEST_CASE("linear_actuator: a positive force pushes two masses apart, and their centre of mass stays at rest") {
  const FinishedRun run = run_tight("linear_actuator", R"toml(
[inputs]
u = { unit = "N", default = 3 }
[[particle]]
name = "P"
mass = "2 kg"
position = { cartesian = ["x", 0, 0] }
[[particle]]
name = "Q"
mass = "1 kg"
position = { cartesian = ["y", 0, 0] }
[[force]]
linear_actuator = { between = ["P", "Q"], force = "u*t/1[s]" }
[scene.default]
t = [0, 2]
initial = { x = 0.1, y = 1.1 }
)toml");
  const double t = 2, work = 3.0 * t * t * t / 6;  // of u t, integrated twice
  CHECK(std::abs(run.final("x") - (0.1 - work / 2)) < same);
  CHECK(std::abs(run.final("y") - (1.1 + work / 1)) < same);
  CHECK(run.simulation.certificate.pass);
}

TEST_CASE(
    "rotary_actuator: the moment is on the second body about the axis, the opposite on the first; so through an "
    "angle") {
  const std::string disks = R"toml(
[inputs]
u = { unit = "N*m", default = 3 }
[[body]]
name = "A"
mass = "1 kg"
inertia = "2 kg*m^2"
rotation = { axis = "E3", angle = "a" }
[[body]]
name = "B"
mass = "1 kg"
inertia = "0.5 kg*m^2"
rotation = { axis = "E3", angle = "b" }
[scene.default]
t = [0, 2]
initial = { a = 0.1, b = 0.2, a_dot = 0.5 }
)toml";
  for (const std::string motor :
       {"bodies = [\"A\", \"B\"], axis = \"-2*A.e3\", moment = \"-u\"", "angle = \"b - a\", moment = \"u\""}) {
    CAPTURE(motor);
    const FinishedRun run = run_tight("rotary_actuator", disks + "[[force]]\nrotary_actuator = { " + motor + " }\n");
    CHECK(std::abs(run.final("a") - (0.1 + 0.5 * 2 - 3.0 / 2 * 2)) < same);  // t^2/2 is 2
    CHECK(std::abs(run.final("b") - (0.2 + 3.0 / 0.5 * 2)) < same);
    CHECK(run.simulation.certificate.pass);
  }
}

TEST_CASE("bushing: on the ground, three damped oscillators along E1, E2, E3 and a pendulum in twice the angle") {
  const FinishedRun run = run_tight("bushing_ground", R"toml(
[parameters]
J = "0.5 kg*m^2"
K = "4 N*m"
[[body]]
name = "B"
mass = "2 kg"
inertia = "J"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "psi" }
[[force]]
bushing = { bodies = ["ground", "B"], at = ["origin", "B"], stiffness = ["50 N/m", "80 N/m", 0], coefficient = ["3 N*s/m", 0, 0], rotational_stiffness = "K" }
[definitions]
first_integral = "J/2*psi_dot^2 + K/2*sin(psi)^2"
[scene.default]
t = [0, 2]
initial = { x = 0.7, y = 0.2, psi = 0.6 }
outputs = ["first_integral", "psi_ddot"]
)toml");
  const double decay = 3.0 / 4, w = std::sqrt(25 - decay * decay), t = 2;
  CHECK(std::abs(run.final("x") - 0.7 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t))) < same);
  CHECK(std::abs(run.final("y") - 0.2 * std::cos(std::sqrt(40.0) * t)) < same);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double psi = run.rows.at(i, "psi");
    CHECK(std::abs(run.rows.at(i, "psi_ddot") + 8 * std::sin(psi) * std::cos(psi)) < same);
    CHECK(std::abs(run.rows.at(i, "first_integral") - 2 * std::sin(0.6) * std::sin(0.6)) < same);
  }
  CHECK(run.simulation.certificate.pass);
}

TEST_CASE("bushing: each of its keys may stand alone") {
  const auto body = [](const std::string& keys) {
    return R"toml(
[[body]]
name = "B"
mass = "2 kg"
inertia = "0.5 kg*m^2"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "psi" }
[[force]]
bushing = { bodies = ["ground", "B"], at = ["origin", "B"], )toml" +
           keys + R"toml( }
[scene.default]
t = [0, 2]
initial = { x = 1, x_dot = 1, psi_dot = 1, psi = 0.5 }
)toml";
  };
  const FinishedRun pushed = run_tight("bushing_pushed", body("coefficient = \"3 N*s/m\"")),
                    turned = run_tight("bushing_turned", body("rotational_coefficient = \"2 N*m*s\"")),
                    held = run_tight("bushing_held", body("rotational_stiffness = \"4 N*m\""));
  CHECK(std::abs(pushed.final("x_dot") - std::exp(-3.0)) < same);
  CHECK(std::abs(pushed.final("psi_dot") - 1) < same);
  CHECK(std::abs(turned.final("psi_dot") - std::exp(-8.0)) < same);
  CHECK(std::abs(turned.final("x_dot") - 1) < same);
  // J/2 psi_dot^2 + K/2 sin(psi)^2 is constant.
  const double psi = held.final("psi"), rate = held.final("psi_dot");
  CHECK(std::abs(rate * rate + 8 * std::sin(psi) * std::sin(psi) - 1 - 8 * std::sin(0.5) * std::sin(0.5)) < same);
  CHECK(std::abs(held.final("x_dot") - 1) < same);
}

TEST_CASE("bushing: two free bodies follow Newton's and Euler's equations; momentum is conserved") {
  const FinishedRun run = run_tight("bushing_free",
                                    R"toml(
[parameters]
m = "2 kg"
J = "0.3 kg*m^2"
L = "0.4 m"
[[body]]
name = "A"
mass = "m"
inertia = { principal = ["J", "2*J", "2.5*J"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { rodrigues = ["a1", "a2", "a3"] }
[[body]]
name = "B"
mass = "m"
inertia = { principal = ["2*J", "J", "1.5*J"] }
position = { cartesian = ["X", "Y", "Z"] }
rotation = { rodrigues = ["b1", "b2", "b3"] }
[[force]]
name = "mount"
bushing = { bodies = ["A", "B"], at = ["A + L*A.e1", "B - L*B.e1"], stiffness = ["100 N/m", "200 N/m", "300 N/m"], coefficient = ["2 N*s/m", "3 N*s/m", "4 N*s/m"], rotational_stiffness = ["5 N*m", "6 N*m", "7 N*m"], rotational_coefficient = ["0.1 N*m*s", "0.2 N*m*s", "0.3 N*m*s"] }
[definitions]
d = "B - L*B.e1 - A - L*A.e1"
v = "ddt(d) - cross(omega(A), d)"
push = "-dot(100[N/m]*d + 2[N*s/m]*v, A.e1)*A.e1 - dot(200[N/m]*d + 3[N*s/m]*v, A.e2)*A.e2 - dot(300[N/m]*d + 4[N*s/m]*v, A.e3)*A.e3"
w = "omega(B) - omega(A)"
p1 = "(dot(B.e2, A.e3) - dot(B.e3, A.e2))/2"
p2 = "(dot(B.e3, A.e1) - dot(B.e1, A.e3))/2"
p3 = "(dot(B.e1, A.e2) - dot(B.e2, A.e1))/2"
c1 = "(cross(B.e2, A.e3) - cross(B.e3, A.e2))/2"
c2 = "(cross(B.e3, A.e1) - cross(B.e1, A.e3))/2"
c3 = "(cross(B.e1, A.e2) - cross(B.e2, A.e1))/2"
spring = "-5[N*m]*p1*c1 - 6[N*m]*p2*c2 - 7[N*m]*p3*c3"
twist = "spring - 0.1[N*m*s]*dot(w, A.e1)*A.e1 - 0.2[N*m*s]*dot(w, A.e2)*A.e2 - 0.3[N*m*s]*dot(w, A.e3)*A.e3"
HA = "J*dot(omega(A), A.e1)*A.e1 + 2*J*dot(omega(A), A.e2)*A.e2 + 2.5*J*dot(omega(A), A.e3)*A.e3"
HB = "2*J*dot(omega(B), B.e1)*B.e1 + J*dot(omega(B), B.e2)*B.e2 + 1.5*J*dot(omega(B), B.e3)*B.e3"
newton_A = "norm(m*acceleration(A) + push)"
newton_B = "norm(m*acceleration(B) - push)"
euler_A = "norm(ddt(HA) + cross(B - L*B.e1 - A, push) + twist)"
euler_B = "norm(ddt(HB) + cross(L*B.e1, push) - twist)"
pushed = "norm(push)"
twisted = "norm(twist)"
[scene.default]
t = [0, 1]
every = 0.1
initial = { X = 0.9, Y = 0.1, b1 = 0.2, a3 = 0.1, b2 = -0.15, x_dot = 0.3, b3_dot = 0.5 }
outputs = ["newton_A", "newton_B", "euler_A", "euler_B", "pushed", "twisted"]
)toml");
  REQUIRE(run.rows.size() == 11);
  double pushed = 0, twisted = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    for (const char* equation : {"newton_A", "newton_B", "euler_A", "euler_B"}) {
      CAPTURE(equation);
      CHECK(run.rows.at(i, equation) < 1e-12);
    }
    pushed = std::max(pushed, run.rows.at(i, "pushed"));
    twisted = std::max(twisted, run.rows.at(i, "twisted"));
  }
  CHECK(pushed > 1);
  CHECK(twisted > 0.5);
  for (const char* name : {"linear_momentum.E1", "angular_momentum.E1", "angular_momentum.E2", "angular_momentum.E3"}) {
    CAPTURE(name);
    CHECK(run.drift(name) < 1e-11);
  }
  CHECK(run.simulation.certificate.pass);
}
