// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's law in spherical coordinates with phi = pi/2 - alpha(t).
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Cone {
  double m, g, K, L0, mu_d, mu_s, alpha0, A = 0, w = 0;

  explicit Cone(const FinishedRun& run, bool moves)
      : m(run.parameter("m")),
        g(run.parameter("g")),
        K(run.parameter("K")),
        L0(run.parameter("L0")),
        mu_d(run.parameter("mu_d")),
        mu_s(run.parameter("mu_s")),
        alpha0(run.parameter(moves ? "alpha0" : "alpha")) {
    if (moves) A = run.parameter("A"), w = run.parameter("w");
  }
  double phi(double t) const { return std::acos(-1.0) / 2 - alpha0 - A * std::sin(w * t); }
  double phi1(double t) const { return -A * w * std::cos(w * t); }
  double phi2(double t) const { return A * w * w * std::sin(w * t); }
  /// Force of the cone along e_phi.
  double normal(double t, const double* x) const {
    const double s = std::sin(phi(t)), c = std::cos(phi(t));
    return m * (x[0] * phi2(t) + 2 * x[2] * phi1(t) - x[0] * s * c * x[3] * x[3]) - m * g * s;
  }
  /// x = R, theta, R_dot, theta_dot.
  void rates(double t, const double* x, double* dx) const {
    const double s = std::sin(phi(t)), c = std::cos(phi(t)), N = std::abs(normal(t, x));
    const double along = x[2], round = x[0] * s * x[3], speed = std::hypot(along, round);
    dx[0] = x[2], dx[1] = x[3];
    dx[2] =
        x[0] * (phi1(t) * phi1(t) + s * s * x[3] * x[3]) - g * c - K / m * (x[0] - L0) - mu_d * N / m * along / speed;
    dx[3] = (-mu_d * N / m * round / speed - 2 * x[2] * s * x[3] - 2 * x[0] * c * phi1(t) * x[3]) / (x[0] * s);
  }
  /// Friction force required for rest on the cone.
  double pull(double t, double R) const {
    return m * (-R * phi1(t) * phi1(t)) + m * g * std::cos(phi(t)) + K * (R - L0);
  }
};

void follows_newton(const std::string& model, bool moves) {
  const FinishedRun run = run_rough(model);
  const Cone cone(run, moves);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "stick");
  HandWrittenMotion hand([&](double t, const double* x, double* dx) { cone.rates(t, x, dx); }, 0,
                         {0.8, 0, 0, run.rows.at(0, "theta_dot")});
  std::size_t compared = 0;
  for (std::size_t i = 1; i < run.rows.size() && run.rows.t[i] < events_of(run)[0].t - 0.01; ++i, ++compared) {
    hand.advance_to(run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "R") - hand.x[0]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta") - hand.x[1]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "R_dot") - hand.x[2]) < 10 * integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta_dot") - hand.x[3]) < 10 * integration_tolerance);
    // lambda grad psi = lambda/R e_phi
    CHECK(std::abs(run.rows.at(i, "reaction.cone") / hand.x[0] - cone.normal(run.rows.t[i], hand.x.data())) <
          100 * integration_tolerance);
    CHECK(run.rows.at(i, "mode.cone") == 1);
  }
  CHECK(compared > 60);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

}  // namespace

TEST_CASE("P4: on the fixed and on the moving cone the particle slides by Newton's law in spherical coordinates") {
  follows_newton("P4_rough_cone", false);
  follows_newton("P4_moving_cone", true);
}

TEST_CASE("P4: at random states the derived accelerations are those of Newton's law") {
  const FinishedRun run = run_rough("P4_moving_cone");
  const Cone cone(run, true);
  StateEvaluation derived(run, "P4_moving_cone");
  UniformSampler draw;
  for (int i = 0; i < 50; ++i) {
    const double t = draw(0, 3);
    const double R = draw(0.2, 2), theta = draw(0, 6), R_dot = draw(-3, 3), theta_dot = draw(-8, 8);
    REQUIRE(derived.slide(t, {R, theta, R_dot, theta_dot}));
    const double x[4] = {R, theta, R_dot, theta_dot};
    double expected[4];
    cone.rates(t, x, expected);
    for (std::size_t k = 2; k < 4; ++k)
      CHECK(derived.dx[k] == doctest::Approx(expected[k]).epsilon(rounding).scale(100));
    CHECK(derived.output("reaction.cone") == doctest::Approx(R * cone.normal(t, x)).epsilon(rounding).scale(100));
  }
}

TEST_CASE("P4: at rest it sticks if the friction cone contains the required force, and slides otherwise") {
  const FinishedRun held = run_rough("P4_rough_cone", "held");
  CHECK(events_of(held).empty());
  const Cone cone(held, false);
  for (std::size_t i = 0; i < held.rows.size(); ++i) {
    CHECK(std::abs(held.rows.at(i, "R") - 0.5) < rounding);
    const double force = std::hypot(held.rows.at(i, "friction.cone.1"), held.rows.at(i, "friction.cone.3"));
    CHECK(force == doctest::Approx(std::abs(cone.pull(0, 0.5))).epsilon(rounding));
  }
  // mu_s N = |pull| with N = m g sin(phi)
  const double critical = std::abs(cone.pull(0, 0.5)) / (cone.m * cone.g * std::sin(cone.phi(0)));
  CHECK(events_of(run_rough("P4_rough_cone", "held", with({{"mu_s", critical * (1 + 1e-9)}, {"mu_d", 0.1}}))).empty());
  const FinishedRun slides = run_rough("P4_rough_cone", "held", with({{"mu_s", critical * (1 - 1e-9)}, {"mu_d", 0.1}}));
  REQUIRE(!events_of(slides).empty());
  CHECK(events_of(slides)[0].kind == "slip");
  CHECK(events_of(slides)[0].t == 0);
}

TEST_CASE("P4: released along its meridian it stops at the point of the closed form") {
  // m R'' = -m g sin(alpha) - K (R - L0) - mu_d N: half an oscillation about the point where these vanish.
  const FinishedRun run = run_rough("P4_rough_cone", "released");
  const Cone cone(run, false);
  const double N = cone.m * cone.g * std::sin(cone.phi(0));
  const double centre = cone.L0 - (cone.m * cone.g * std::cos(cone.phi(0)) + cone.mu_d * N) / cone.K;
  REQUIRE(events_of(run).size() == 2);
  CHECK(events_of(run)[1].kind == "stick");
  CHECK(std::abs(events_of(run)[1].t - std::acos(-1.0) * std::sqrt(cone.m / cone.K)) < integration_tolerance);
  CHECK(std::abs(run.final("R") - (2 * centre - 0.3)) < integration_tolerance);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("P4: carried by the cone it slips when the required force first exceeds the static friction") {
  const FinishedRun run = run_rough("P4_moving_cone", "shaken");
  const Cone cone(run, true);
  const double R = 0.45;
  const double still[4] = {R, 0, 0, 0};
  const auto spare = [&](double t) { return cone.mu_s * std::abs(cone.normal(t, still)) - std::abs(cone.pull(t, R)); };
  const double first = root_between(spare, 0, 1);
  REQUIRE(events_of(run).size() >= 8);
  CHECK(std::abs(events_of(run)[0].t - first) < integration_tolerance);
  for (std::size_t i = 0; i < events_of(run).size(); ++i)
    CHECK(events_of(run)[i].kind == (i % 2 == 0 ? "slip" : "stick"));
  CHECK(run.simulation.result.power_balance < 1e-9);
  for (std::size_t i = 0; i < run.rows.size() && run.rows.t[i] < first; ++i) {
    CHECK(run.rows.at(i, "R") == doctest::Approx(R).epsilon(rounding));
    const double phi = cone.phi(run.rows.t[i]);  // friction along e_R
    const double along =
        run.rows.at(i, "friction.cone.1") * std::sin(phi) + run.rows.at(i, "friction.cone.3") * std::cos(phi);
    CHECK(along == doctest::Approx(cone.pull(run.rows.t[i], R)).epsilon(1e-11).scale(1));
  }
}
