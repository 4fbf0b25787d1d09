// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/reference_integration.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

struct Masses {
  double m1, m2, k1, k2, l0, f0, w;
  double f(double t) const { return f0 * std::cos(w * t); }
  double v1(double t, double x1, double x2, double v2) const { return (f(t) - x1 * v2) * l0 / (x2 * x2); }

  // (x1, x2, v2) with the multiplier eliminated by hand: x1 times the first equation less x2^2/l0 times the second.
  int operator()(double t, const double* x, double* dx) const {
    const double x1 = x[0], x2 = x[1], v2 = x[2], v1 = this->v1(t, x1, x2, v2);
    const double b = x2 * x2 / l0;
    // b a1 + x1 a2 = rate
    const double rate = -f0 * w * std::sin(w * t) - v1 * v2 - 2 * x2 * v2 / l0 * v1;
    const double F1 = -k1 * x1 - k2 * (x1 - x2), F2 = -k2 * (x2 - x1);
    // x1 (m1 a1 - F1) = b (m2 a2 - F2)
    const double a2 = (x1 * m1 * rate / b - x1 * F1 + b * F2) / (b * m2 + x1 * x1 * m1 / b);
    dx[0] = v1;
    dx[1] = v2;
    dx[2] = a2;
    return 0;
  }
};

}  // namespace

TEST_CASE("S2: the multiplier form agrees with y' = f(y) with a hand-eliminated velocity") {
  const test::FinishedRun run = test::run_model("S2_two_masses_pfaffian", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  const Masses masses{run.parameter("m1"), run.parameter("m2"), run.parameter("k1"), run.parameter("k2"),
                      run.parameter("l0"), run.parameter("f0"), run.parameter("w")};
  std::vector<double> x{0.5, 0.8, 0.1};
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    x = test::integrate_reference(masses, run.rows.t[i - 1], x, run.rows.t[i], 1e-13, 1e-14);
    CHECK(std::abs(run.rows.at(i, "x1") - x[0]) < 1e-10);
    CHECK(std::abs(run.rows.at(i, "x2") - x[1]) < 1e-10);
    CHECK(std::abs(run.rows.at(i, "x1_dot") - masses.v1(run.rows.t[i], x[0], x[1], x[2])) < 1e-9);
    // m1 x1'' = -k1 x1 - k2 (x1 - x2) + lambda x2^2/l0 and m2 x2'' = k2 (x1 - x2) + lambda x1: (3.64)
    double dx[3];
    masses(run.rows.t[i], x.data(), dx);
    const double lambda = (masses.m2 * dx[2] - masses.k2 * (x[0] - x[1])) / x[0];
    CHECK(std::abs(run.rows.at(i, "reaction.pair") - lambda) < 1e-8);
  }
  CHECK(run.simulation.result.power_balance < 1e-11);  // it is -lambda times f, which the constraint does
  CHECK(run.simulation.result.constraint_drift < 1e-14);
}

TEST_CASE("S2: the start determines the dependent velocity") {
  const test::FinishedRun run = test::run_model(
      "S2_two_masses_pfaffian", [](pipeline::SimulationRequest& request) { request.overrides.t_end = 0.1; });
  CHECK(run.rows.at(0, "x1_dot") == doctest::Approx((0.3 - 0.5 * 0.1) / 0.64).epsilon(1e-15));
  REQUIRE(run.simulation.scene.solved_notes.size() == 1);
  CHECK(run.simulation.scene.solved_notes[0].starts_with("x1_dot = "));
}

TEST_CASE(
    "S2: the multiplier, null space and Chaplygin forms agree to 45 digits at random points and to 1e-9 along a run") {
  const std::unique_ptr<pipeline::DerivedModel> derived =
      pipeline::derive_model(test::model_at(test::model_path("S2_two_masses_pfaffian")),
                             pipeline::ApproachChoice::automatic, system::Form::multipliers);
  const program::Program multipliers = pipeline::make_program(*derived, {});
  const verify::Certificate certificate = pipeline::certify(*derived, multipliers, {50, 20, 1, nullptr});
  CHECK(certificate.pass);
  std::size_t forms = 0;
  for (const verify::Comparison& c : certificate.comparisons) {
    if (!c.a.starts_with("form ")) continue;
    INFO(c.a, " against ", c.b);
    CHECK(c.max_relative_difference < 1e-45);
    ++forms;
  }
  CHECK(forms == 2);  // the other two
  const auto run = [](system::Form form) {
    return test::run_model("S2_two_masses_pfaffian", [form](pipeline::SimulationRequest& request) {
      request.form = form;
      request.overrides.rtol = request.overrides.atol = 1e-12;
    });
  };
  const test::FinishedRun reference = run(system::Form::multipliers);
  for (const system::Form form : {system::Form::nullspace, system::Form::chaplygin}) {
    const test::FinishedRun other = run(form);
    CHECK(other.simulation.program.form == form);
    REQUIRE(other.rows.size() == reference.rows.size());
    for (std::size_t i = 0; i < reference.rows.size(); ++i) {
      for (const char* name : {"x1", "x2", "x1_dot", "x2_dot"})
        CHECK(std::abs(other.rows.at(i, name) - reference.rows.at(i, name)) < 1e-9);
      CHECK(std::abs(other.rows.at(i, "reaction.pair") - reference.rows.at(i, "reaction.pair")) < 1e-7);  // some 100 N
    }
  }
}
