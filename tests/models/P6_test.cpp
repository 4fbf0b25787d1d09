// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's law in polar coordinates with the friction of (2.44).
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Circle {
  explicit Circle(const FinishedRun& run)
      : m(run.parameter("m")),
        g(run.parameter("g")),
        beta(run.parameter("beta")),
        l0(run.parameter("l0")),
        A(run.parameter("A")),
        w(run.parameter("w")),
        mu_d(run.parameter("mu_d")),
        mu_s(run.parameter("mu_s")) {}
  double L(double t) const { return l0 + A * std::sin(w * t); }
  double L1(double t) const { return A * w * std::cos(w * t); }
  double L2(double t) const { return -A * w * w * std::sin(w * t); }
  double along_r(double t, double theta, double rate) const {
    return m * (L2(t) - L(t) * rate * rate) + m * g * std::cos(beta) * std::sin(theta);
  }
  double along_z() const { return m * g * std::sin(beta); }
  double normal(double t, double theta, double rate) const { return std::hypot(along_r(t, theta, rate), along_z()); }
  double acceleration(double t, double theta, double rate, double sign) const {
    return (-g * std::cos(beta) * std::cos(theta) - sign * mu_d * normal(t, theta, rate) / m - 2 * L1(t) * rate) / L(t);
  }
  double m, g, beta, l0, A, w, mu_d, mu_s;
};

}  // namespace

TEST_CASE(
    "P6: at random states both multipliers, the friction of (2.44) and the acceleration are those of Newton's law") {
  const FinishedRun run = run_rough("P6_rough_circle");
  const Circle c(run);
  StateEvaluation derived(run, "P6_rough_circle");
  UniformSampler draw;
  for (int i = 0; i < 50; ++i) {
    const double t = draw(0, 6), theta = draw(-4, 4), rate = draw(-8, 8), sign = rate > 0 ? 1 : -1;
    REQUIRE(derived.slide(t, {theta, rate}));
    CHECK(derived.dx[1] == doctest::Approx(c.acceleration(t, theta, rate, sign)).epsilon(rounding).scale(100));
    CHECK(derived.output("reaction.circle.1") ==
          doctest::Approx(c.along_r(t, theta, rate)).epsilon(rounding).scale(100));
    CHECK(derived.output("reaction.circle.2") == doctest::Approx(c.along_z()).epsilon(rounding));
    const double F = -sign * c.mu_d * c.normal(t, theta, rate);
    CHECK(derived.output("friction.circle.1") == doctest::Approx(-F * std::sin(theta)).epsilon(rounding).scale(10));
    CHECK(derived.output("friction.circle.2") == doctest::Approx(F * std::cos(theta)).epsilon(rounding).scale(10));
  }
}

TEST_CASE("P6: between events the particle follows the hand-written equation, until it sticks") {
  const FinishedRun run = run_rough("P6_rough_circle");
  const Circle c(run);
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() == 4);
  double sign = 1;
  HandWrittenMotion hand(
      [&](double t, const double* x, double* dx) { dx[0] = x[1], dx[1] = c.acceleration(t, x[0], x[1], sign); }, 0,
      {-std::acos(-1.0) / 2, 8});
  for (std::size_t k = 0; k < events.size(); ++k) {
    CHECK(events[k].kind == (k + 1 < events.size() ? "reverse" : "stick"));
    hand.advance_to(events[k].t);
    CHECK(std::abs(hand.x[1]) < 100 * integration_tolerance);  // at rest: about 10 rad/s^2 times the error of the time
    sign = -sign;
  }
  CHECK(std::abs(run.final("theta") - hand.x[0]) < integration_tolerance);
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    if (run.rows.t[i] <= events.back().t) continue;
    const double N = c.normal(run.rows.t[i], run.rows.at(i, "theta"), 0);
    CHECK(std::hypot(run.rows.at(i, "friction.circle.1"), run.rows.at(i, "friction.circle.2")) < c.mu_s * N);
  }
}

TEST_CASE("P6: on a level circle of constant radius it stops after asinh(L w^2/g)/(2 mu)") {
  const FinishedRun run = run_rough("P6_rough_circle", "flat");
  const Circle c(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(std::abs(run.final("theta") - std::asinh(c.l0 * 25 / c.g) / (2 * c.mu_d)) < integration_tolerance);
  const double time = simpson([&](double rate) { return 1 / (c.mu_d * std::hypot(c.g / c.l0, rate * rate)); }, 0, 5);
  CHECK(std::abs(events_of(run)[0].t - time) < integration_tolerance);
}

TEST_CASE("P6: an oscillating circle carries a sticking particle, and its power is the rate of the energy") {
  const FinishedRun run = run_rough("P6_rough_circle", "held");
  CHECK(events_of(run).empty());
  const Circle c(run);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i], theta = -std::acos(-1.0) / 2 + 0.1;
    CHECK(std::abs(run.rows.at(i, "theta") - theta) < integration_tolerance);
    const double friction =
        run.rows.at(i, "friction.circle.2") * std::cos(theta) - run.rows.at(i, "friction.circle.1") * std::sin(theta);
    CHECK(friction == doctest::Approx(c.m * c.g * std::cos(c.beta) * std::cos(theta)).epsilon(1e-11));
    const double energy = c.m / 2 * c.L1(t) * c.L1(t) + c.m * c.g * std::cos(c.beta) * c.L(t) * std::sin(theta);
    CHECK(run.rows.at(i, "energy") == doctest::Approx(energy).epsilon(1e-11));
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}
