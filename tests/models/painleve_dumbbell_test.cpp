// SPDX-License-Identifier: GPL-3.0-or-later
// From the two balances of the dumbbell: theta_ddot = (-N cos + F sin)/(m L), x_c_ddot = F/(2 m), and y_A_ddot = 0
// gives N.
#include <doctest/doctest.h>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Dumbbell {
  explicit Dumbbell(const FinishedRun& run)
      : m(run.parameter("m")), L(run.parameter("L")), mu(run.parameter("mu")), g(run.parameter("g")) {}
  double normal(double theta, double spin, double way) const {
    const double s = std::sin(theta), c = std::cos(theta);
    return (2 * m * g - m * L * spin * spin * s) / (1 + c * c + way * mu * s * c);
  }
  /// x, theta and their rates, sliding with N > 0.
  void rates(const double* x, double* dx) const {
    const double s = std::sin(x[1]), c = std::cos(x[1]), way = x[2] > 0 ? 1 : -1, N = normal(x[1], x[3], way),
                 F = -way * mu * N;
    dx[0] = x[2], dx[1] = x[3];
    dx[3] = (-N * c + F * s) / (m * L);
    dx[2] = F / (2 * m) + L / 2 * (dx[3] * s + x[3] * x[3] * c);  // x_c = x + L/2 cos(theta)
  }
  double m, L, mu, g;
};

}  // namespace

TEST_CASE(
    "painleve_dumbbell: above mu = 2 sqrt 2 it ends where a second solution appears, at tan(theta) = (mu + sqrt(mu^2 - "
    "8))/2") {
  const FinishedRun run = run_rough("painleve_dumbbell");
  const Dumbbell d(run);
  CHECK(run.simulation.result.outcome == eom::Outcome::friction_many_solutions);
  const double tangent = (d.mu + std::sqrt(d.mu * d.mu - 8)) / 2;
  CHECK(std::abs(std::tan(run.final("theta")) - tangent) < integration_tolerance);
  HandWrittenMotion hand([&](double, const double* x, double* dx) { d.rates(x, dx); }, 0, {0, 1.5, 5, -0.1});
  hand.advance_to(run.simulation.result.t);
  CHECK(std::abs(run.final("x") - hand.x[0]) < integration_tolerance);
  CHECK(std::abs(run.final("theta") - hand.x[1]) < integration_tolerance);
  CHECK(std::abs(run.final("x_dot") - hand.x[2]) < 10 * integration_tolerance);
  CHECK(run.final("reaction.floor") == doctest::Approx(d.normal(hand.x[1], hand.x[3], 1)).epsilon(1e-9));
}

TEST_CASE("painleve_dumbbell: below it, the run follows the hand-written balances until it sticks") {
  const FinishedRun run = run_rough("painleve_dumbbell", "below");
  const Dumbbell d(run);
  CHECK(d.mu < 2 * std::sqrt(2.0));
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  REQUIRE(events_of(run).size() >= 1);
  HandWrittenMotion hand([&](double, const double* x, double* dx) { d.rates(x, dx); }, 0, {0, 1.5, 5, -0.1});
  for (std::size_t i = 1; i < run.rows.size() && run.rows.t[i] < events_of(run)[0].t - 1e-3; ++i) {
    hand.advance_to(run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "x") - hand.x[0]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta") - hand.x[1]) < integration_tolerance);
    CHECK(run.rows.at(i, "reaction.floor") == doctest::Approx(d.normal(hand.x[1], hand.x[3], 1)).epsilon(1e-9));
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE(
    "painleve_dumbbell: dragged backwards at such an angle no force obeys the law, and below the critical mu one "
    "does") {
  const FinishedRun none = run_rough("painleve_dumbbell", "none");
  CHECK(none.simulation.result.outcome == eom::Outcome::friction_no_solution);
  CHECK(none.simulation.result.t == 0);
  const double critical = 2 * std::sqrt(2.0);
  for (const double off : {1e-6, -1e-6}) {
    const FinishedRun run = run_rough("painleve_dumbbell", "none", [&](pipeline::SimulationRequest& request) {
      with({{"mu", critical + off}})(request);
      request.overrides.t_end = 1e-6;
    });
    // pi/3.3 is not where tan(theta) = sqrt(2), so that both are below what this angle needs.
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
  }
}
