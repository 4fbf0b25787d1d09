// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

void tighten_top(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-12;
  request.overrides.atol = 1e-12;
}

struct Flight {
  double m, R, g, B, rho, Cd;
  Vector3d w{10, 30, 180};  // the start has the body's axes along E1, E2, E3

  explicit Flight(const test::FinishedRun& run)
      : m(run.parameter("m")),
        R(run.parameter("R")),
        g(run.parameter("g")),
        B(run.parameter("B")),
        rho(run.parameter("rho")),
        Cd(run.parameter("Cd")) {}
  Vector3d acceleration(const Vector3d& v) const {
    const double A = std::acos(-1.0) * R * R;
    return Vector3d(0, 0, -g) + B * w.cross(v) - rho * A * Cd / (2 * m) * v.norm() * v;
  }
};

}  // namespace

// vdot = -g E3 + B w x v with constant w, eq. (8.59) with its signs put right: along w a free fall, across it v - v_s
// turns about w with the rate B|w|, where v_s is the velocity for which lift and weight balance.
TEST_CASE("R2: without drag the ball follows the closed form of (8.63)") {
  const test::FinishedRun run = test::run_model("R2_ball_in_flight", tighten_top);
  const Flight f(run);
  const Vector3d n = f.w.normalized(), gravity(0, 0, -f.g), across = gravity - gravity.dot(n) * n;
  const double turn = f.B * f.w.norm();
  const Vector3d steady = n.cross(across) / turn;  // B w x v_s = -across
  const Vector3d x0(0, 0, 1.8), v0(40, 0, 2), rest = v0 - v0.dot(n) * n - steady;
  double worst = 0, drift = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i];
    const Vector3d x = x0 + (v0.dot(n) * t + gravity.dot(n) * t * t / 2) * n + steady * t +
                       std::sin(turn * t) / turn * rest + (1 - std::cos(turn * t)) / turn * n.cross(rest);
    const Vector3d found(run.rows.at(i, "x1"), run.rows.at(i, "x2"), run.rows.at(i, "x3"));
    worst = std::max(worst, (found - x).norm());
    for (int k = 0; k < 3; ++k)
      drift = std::max(drift, std::abs(run.rows.at(i, "ball.omega" + std::to_string(k + 1)) - f.w[k]));
  }
  CHECK(worst < 1e-9);
  CHECK(drift < 1e-8);         // of 180 rad/s
  CHECK(run.final("x2") > 1);  // the lift bends the flight
}

TEST_CASE("R2: with drag it agrees with a separate integration of vdot") {
  const test::FinishedRun run = test::run_model("R2_ball_in_flight", [](pipeline::SimulationRequest& request) {
    tighten_top(request);
    request.scene = "drag";
  });
  const Flight f(run);
  Vector3d x(0, 0, 1.8), v(40, 0, 2);
  constexpr int steps = 4000;  // of the classical Runge-Kutta method: errors of 1e-13
  const double h = 2.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector3d a1 = f.acceleration(v), v2 = v + h / 2 * a1, a2 = f.acceleration(v2), v3 = v + h / 2 * a2,
                   a3 = f.acceleration(v3), v4 = v + h * a3, a4 = f.acceleration(v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  CHECK(run.final("x1") == doctest::Approx(x[0]).epsilon(1e-10));
  CHECK(run.final("x2") == doctest::Approx(x[1]).epsilon(1e-10));
  CHECK(run.final("x3") == doctest::Approx(x[2]).epsilon(1e-9));
  CHECK(run.final("x1_dot") < 30);
}
