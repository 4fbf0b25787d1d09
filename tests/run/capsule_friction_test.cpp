// SPDX-License-Identifier: GPL-3.0-or-later
// Friction of two capsules beside a motion that the test integrates itself: Newton's and Euler's equations of two rods
// whose lines cross, with a normal force that keeps their distance.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "support/run_text.hpp"

using namespace eomgen;

namespace {

using Point = std::array<double, 3>;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Point operator-(const Point& a, const Point& b) { return a + -1.0 * b; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const Point& a) { return std::sqrt(dot(a, a)); }

/// Two rods whose lines cross: places, directions of their axes, velocities and angular velocities.
struct Rods {
  std::array<Point, 2> x, u, v, w;
};
Rods shifted(const Rods& a, double h, const Rods& rate) {
  Rods r = a;
  for (std::size_t k = 0; k < 2; ++k) {
    r.x[k] = a.x[k] + h * rate.x[k], r.u[k] = a.u[k] + h * rate.u[k];
    r.v[k] = a.v[k] + h * rate.v[k], r.w[k] = a.w[k] + h * rate.w[k];
  }
  return r;
}

constexpr double m_rod = 2, I_rod = 0.1, push = 5, mu = 0.3, radii = 0.15, r_first = 0.1;

/// Rates of the rods, which slide on one another: the normal force keeps the distance of the lines, d . n with the unit
/// normal n across both, and friction is against the slip of the points that touch.
Rods sliding(const Rods& a) {
  const Point across = cross(a.u[0], a.u[1]), d = a.x[0] - a.x[1];
  const double side = dot(d, across) > 0 ? 1 : -1, sine = norm(across);
  const Point n = side / sine * across;
  // d + s u - t v is along n.
  const double s = -dot(cross(d, a.u[1]), across) / (sine * sine), t = -dot(cross(d, a.u[0]), across) / (sine * sine);
  const std::array<Point, 2> arm{s * a.u[0] - r_first * n, t * a.u[1] + (radii - r_first) * n};
  const Point slip = a.v[0] + cross(a.w[0], arm[0]) - a.v[1] - cross(a.w[1], arm[1]);  // along n only by rounding
  const Point F = n - mu / norm(slip) * slip;
  const auto rates = [&](double N) {
    Rods r;
    for (std::size_t k = 0; k < 2; ++k) {
      const double sign = k == 0 ? 1 : -1;
      r.x[k] = a.v[k], r.u[k] = cross(a.w[k], a.u[k]);
      r.v[k] = sign / m_rod * (N * F - Point{0, 0, push});
      r.w[k] = sign * N / I_rod * cross(arm[k], F);
    }
    return r;
  };
  // The second derivative of the distance along a motion with these accelerations, by differences; affine in N.
  const auto curvature = [&](double N) {
    const Rods r = rates(N);
    const auto distance = [&](double h) {
      std::array<Point, 2> x, u;
      for (std::size_t k = 0; k < 2; ++k) {
        x[k] = a.x[k] + h * a.v[k] + h * h / 2 * r.v[k];
        const Point turn = cross(r.w[k], a.u[k]) + cross(a.w[k], cross(a.w[k], a.u[k]));
        u[k] = a.u[k] + h * r.u[k] + h * h / 2 * turn;
      }
      const Point c = cross(u[0], u[1]);
      return side * dot(x[0] - x[1], c) / norm(c);
    };
    const auto second = [&](double h) { return (distance(h) - 2 * distance(0) + distance(-h)) / (h * h); };
    return (4 * second(1e-3) - second(2e-3)) / 3;
  };
  const double at_0 = curvature(0), at_1 = curvature(1);
  return rates(at_0 / (at_0 - at_1));
}

}  // namespace

TEST_CASE("capsules: one slides over another with friction as Newton's and Euler's equations state") {
  const auto body = [](const std::string& n, const std::string& force) {
    return "[[body]]\nname = \"" + n +
           "\"\nmass = 2\ninertia = { principal = [0.1, 0.1, 0.1] }\nposition = { "
           "cartesian = [\"x" +
           n + "\", \"y" + n + "\", \"z" + n + "\"] }\nrotation = { euler_parameters = [\"p" + n + "\", \"q" + n +
           "\", \"r" + n + "\", \"s" + n + "\"] }\n[[force]]\non = \"" + n + "\"\nforce = \"" + force + "*E3\"\n";
  };
  // A lies along E1 upon B, which lies along E2. A moves and turns about E3.
  const std::string text =
      body("A", "-5") + body("B", "5") +
      "[[contact]]\nname = \"c\"\ncapsules = { A = [0.1, 0.8], B = [0.05, 1.2] }\nfriction = { static = 0.3, "
      "dynamic = 0.3 }\n[scene.default]\nt = [0, 0.25]\ninitial = { zA = 0.15, xA_dot = 0.5, yA_dot = 0.3, pA "
      "= \"sqrt(1/2)\", qA = 0, rA = \"sqrt(1/2)\", sA = 0, qA_dot = \"-0.4*sqrt(1/2)\", sA_dot = "
      "\"0.4*sqrt(1/2)\", xB = 0.1, yB = -0.2, zB = 0, pB = \"sqrt(1/2)\", qB = \"-sqrt(1/2)\", rB = 0, sB = 0 "
      "}\nrtol = 1e-11\natol = 1e-12\noutputs = [\"gap.c_A_B\", \"mode.c_A_B\", \"slip.c_A_B.1\", "
      "\"slip.c_A_B.2\"]\n";
  const test::FinishedRun run = test::run_text("capsules_with_friction", text);
  const run::RunResult& result = run.simulation.result;
  CHECK(result.outcome == eom::Outcome::done);
  CHECK(result.events.empty());  // it slides all the time

  Rods rods{{{{0, 0, 0.15}, {0.1, -0.2, 0}}}, {{{1, 0, 0}, {0, 1, 0}}}, {{{0.5, 0.3, 0}, {}}}, {{{0, 0, 0.8}, {}}}};
  const int steps = 500;
  for (int i = 0; i < steps; ++i) {
    const double h = 0.25 / steps;
    const Rods k1 = sliding(rods), k2 = sliding(shifted(rods, h / 2, k1)), k3 = sliding(shifted(rods, h / 2, k2)),
               k4 = sliding(shifted(rods, h, k3));
    rods = shifted(shifted(shifted(shifted(rods, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  }
  CHECK(std::abs(run.final("gap.c_A_B")) < 1e-10);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string n = k == 0 ? "A" : "B";
    const auto at = [&](const std::string& name) { return run.final(name + n); };
    const double p = at("p"), q = at("q"), r = at("r"), s = at("s");
    const Point x{at("x"), at("y"), at("z")},
        e3{2 * (q * s + p * r), 2 * (r * s - p * q), p * p - q * q - r * r + s * s};
    CHECK(norm(x - rods.x[k]) < 1e-8);  // differences of differences are good to 1e-9 of the force
    CHECK(norm(e3 - rods.u[k]) < 1e-8);
  }
  CHECK(norm(rods.v[0] - Point{0.5, 0.3, 0}) > 0.1);  // friction had an effect
}
