// SPDX-License-Identifier: GPL-3.0-or-later
// Linearisations against closed forms, and against difference quotients of the flow on the constraints.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "linearised.hpp"

using namespace eomgen;
using namespace eomgen::test;
using linear::MotionKind;
using linear::Precise;

namespace {

/// dY/dy by central differences in 160 digits: y is varied, the other entries are solved from the constraints.
void holds_against_differences(const Linearised& x) {
  const linear::Flow& flow = *x.problem.flow;
  const auto& chart = x.l.symmetry.chart;
  const Precise h = linear::tiny<Precise>(30);
  for (std::size_t k = 0; k < chart.independent.size(); ++k) {
    std::vector<linear::Field<Precise>> fields;
    for (const int side : {1, -1}) {
      linear::State<Precise> z = x.l.z;
      z[chart.independent[k]] = z[chart.independent[k]] + Precise(side) * h;
      const auto moved = linear::project_onto_constraints(flow, z, x.l.setting, chart.dependent);
      REQUIRE(moved);
      fields.push_back(flow.at(*moved, x.l.setting));
    }
    for (std::size_t j = 0; j < chart.independent.size(); ++j) {
      const std::size_t row = chart.independent[j];
      const Precise slope = (fields[0].X(row, 0) - fields[1].X(row, 0)) / (Precise(2) * h);
      CAPTURE(row);
      CHECK(linear::magnitude(slope - x.l.A(j, k)) <
            linear::tiny<Precise>(50));  // the step squared, times third derivatives
    }
  }
}

const char* const hanging =
    "\n[scene.hanging]\nfrom = \"default\"\ninitial = { theta = 0 }\n[scene.upright]\nfrom = \"default\"\ninitial = { "
    "theta = \"pi\" }\n";

}  // namespace

TEST_CASE("cart and pendulum: A and B at both equilibria are those of the linear equations, x is a structural zero") {
  for (const char* scene : {"hanging", "upright"}) {
    const Linearised x = linearised("cart_pendulum", scene, hanging);
    const double M = x.parameter("M"), m = x.parameter("m"), l = x.parameter("l"), g = x.parameter("g"),
                 c = x.parameter("c");
    const double s = scene == std::string("hanging") ? 1 : -1;
    CHECK(x.l.kind == MotionKind::equilibrium);
    same(x.A("x_dot", "theta"), m * g / M);
    same(x.A("x_dot", "x_dot"), -c / M);
    same(x.A("theta_dot", "theta"), -s * g * (1 + m / M) / l);
    same(x.A("theta_dot", "x_dot"), s * c / (M * l));
    same(x.B("x_dot", 0), 1 / M);
    same(x.B("theta_dot", 0), -s / (M * l));
    CHECK(x.A("x_dot", "x") == 0);
    CHECK(x.zeros() == 1);
    CHECK(x.l.structural_zeros == 1);
    CHECK((x.value(0).re > 0) == (s < 0));
    holds_against_differences(x);
  }
}

TEST_CASE(
    "double pendulum: the frequencies sqrt((2 +- sqrt 2) g/L), with rods built in and as constraints in x and y") {
  const Linearised angles = linearised("S5_double_pendulum", "rest",
                                       "\n[scene.rest]\nfrom = \"default\"\ninitial = { theta1 = 0, theta2 = 0 }\n");
  const Linearised cartesian =
      linearised("S5_double_pendulum_cartesian", "rest",
                 "\n[scene.rest]\nt = [0, 1]\ninitial = { y1 = 0, y2 = 0 }\nguess = { x1 = 1, x2 = 2 }\n");
  const double g = angles.parameter("g");
  for (const Linearised* x : {&angles, &cartesian}) {
    CHECK(x->l.kind == MotionKind::equilibrium);
    REQUIRE(x->l.spectrum.values.size() == 4);
    const double high = std::sqrt((2 + std::sqrt(2.0)) * g), low = std::sqrt((2 - std::sqrt(2.0)) * g);
    const double expected[] = {high, low, -low, -high};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(x->value(i).re == 0);
      same(x->value(i).im, expected[i]);
    }
    CHECK(x->zeros() == 0);
    holds_against_differences(*x);
  }
}

TEST_CASE(
    "Lagrange top: slow precession is steady, its nutation has V''/I of the amended potential, four zeros are "
    "structural") {
  const Linearised x = linearised("R10_lagrange_top", "steady");
  const double I = x.parameter("Jt") + x.parameter("m") * std::pow(x.parameter("L"), 2), W = x.parameter("slow"),
               c = std::cos(x.parameter("tilt"));
  const double a = x.parameter("Ja") * x.parameter("spin"), s2 = 1 - c * c,
               weight = x.parameter("m") * x.parameter("g") * x.parameter("L");
  const double square = (a * a / I - 3 * a * W * c + I * W * W * (s2 + 3 * c * c) - weight * c) / I;
  CHECK(x.l.kind == MotionKind::steady);
  CHECK(x.zeros() == 4);
  CHECK(x.l.structural_zeros == 4);
  same(x.value(0).im, std::sqrt(square));
  same(x.value(5).im, -std::sqrt(square));
  CHECK(x.value(0).re == 0);
}

// (A + m R^2) theta'' = A p^2 sin cos - (C + m R^2) p w sin - m g R cos, A p' sin = (C w - 2 A p cos) theta', (C + m
// R^2) w' = m R^2 p sin theta' with p = phi', w = psi' + p cos(theta): (9.93), corrected, with the forces of contact
// eliminated.
TEST_CASE(
    "rolling disk: a steady circle and its frequency are those of the closed form; non-holonomic constraints reduce "
    "speeds only") {
  const double m = 0.5, R = 0.2, g = 9.81, A = m * R * R / 4, C = 2 * A, K = C + m * R * R, theta = 1.1, p = 2.5;
  const double s = std::sin(theta), c = std::cos(theta), w = (A * p * p * s * c - m * g * R * c) / (K * p * s);
  const Linearised x = linearised(
      "R6_rolling_disk", "circle",
      fmt::format(
          "\n[scene.circle]\nfrom = \"default\"\ninitial = {{ theta = 1.1, phi_dot = 2.5, psi_dot = {:.17g} }}\n",
          w - p * c));
  CHECK(x.l.kind == MotionKind::steady);
  REQUIRE(x.l.spectrum.values.size() == 8);  // five positions, three speeds
  const double slope = A * p * p * (c * c - s * s) - K * p * w * c + m * g * R * s,
               by_p = 2 * A * p * s * c - K * w * s, by_w = -K * p * s;
  const double square =
      -(slope + by_p * (C * w - 2 * A * p * c) / (A * s) + by_w * m * R * R * p * s / K) / (A + m * R * R);
  REQUIRE(square > 0);
  same(x.value(0).im, std::sqrt(square));
  CHECK(x.value(0).re == 0);
  CHECK(x.zeros() == 6);
  CHECK(x.l.structural_zeros == 6);
  holds_against_differences(x);
}

TEST_CASE(
    "rolling disk: straight rolling is unstable up to psi_dot^2 = g/(3 R), spinning up to phi_dot^2 = 4 g/(5 R)") {
  for (const bool rolls : {true, false}) {
    const double R = 0.2, g = 9.81, critical = std::sqrt(rolls ? g / (3 * R) : 4 * g / (5 * R));
    for (const double factor : {0.99, 1.01}) {
      const Linearised x = linearised("R6_rolling_disk", "upright",
                                      fmt::format("\n[scene.upright]\nfrom = \"default\"\ninitial = {{ theta = "
                                                  "\"pi/2\", psi_dot = {:.17g}, phi_dot = {:.17g} }}\n",
                                                  rolls ? factor * critical : 0, rolls ? 0 : factor * critical));
      CHECK(x.l.kind == MotionKind::steady);
      CHECK((x.value(0).re > 0) == (factor < 1));
    }
  }
}

TEST_CASE("sleigh: deviations decay at the rate m L1 u/(J + m L1^2) straight ahead and grow at it astern") {
  for (const double u : {5.0, -5.0}) {
    const Linearised x =
        linearised("R13_sleigh", "ahead",
                   fmt::format("\n[scene.ahead]\nfrom = \"default\"\ninitial = {{ x1_dot = {}, phi_dot = 0 }}\n", u));
    const double m = x.parameter("m"), L1 = x.parameter("L1"), rate = -m * L1 * u / (x.parameter("J") + m * L1 * L1);
    CHECK(x.l.kind == MotionKind::steady);
    CHECK(x.l.structural_zeros == 4);  // position, direction, speed
    same(x.value(u > 0 ? 4 : 0).re, rate);
  }
}

TEST_CASE(
    "rotating hoop: at the critical rate a zero pair exists for these parameters only; the system is autonomous") {
  const Linearised x = linearised(
      "rotating_hoop", "bottom",
      "\n[scene.bottom]\nfrom = \"default\"\ninitial = { beta = 0 }\nparameters = { w = \"3 rad/s\", R = 1, g = 9 }\n");
  CHECK(x.l.symmetry.autonomous);
  CHECK(x.l.kind == MotionKind::equilibrium);
  CHECK(x.zeros() == 2);
  CHECK(x.l.structural_zeros == 0);
  const Linearised free =
      linearised("rotating_hoop", "bottom", "\n[scene.bottom]\nfrom = \"default\"\ninitial = { beta = 0 }\n");
  same(free.value(0).re, std::sqrt(36 - free.parameter("g") / free.parameter("R")));
}

TEST_CASE("a state on no steady motion is linearised along its motion and reported as such") {
  const Linearised x = linearised("R6_rolling_disk");
  CHECK(x.l.kind == MotionKind::motion);
  holds_against_differences(x);
  const Linearised moving = linearised("P1_spherical_pendulum_varying");
  CHECK(moving.l.kind == MotionKind::motion);
  CHECK_FALSE(moving.l.symmetry.autonomous);
  holds_against_differences(moving);
  holds_against_differences(linearised("R1_free_body_euler_parameters"));
}

TEST_CASE("the state at a given time is that of the run") {
  const Linearised x = linearised("S5_double_pendulum", "default", "", {}, 1.5);
  const FinishedRun run =
      run_model("S5_double_pendulum", [](pipeline::SimulationRequest& request) { request.overrides.t_end = 1.5; });
  CHECK(x.at("theta1") == run.final("theta1"));
  CHECK(x.at("theta2_dot") == run.final("theta2_dot"));
  CHECK(x.l.kind == MotionKind::motion);
}
