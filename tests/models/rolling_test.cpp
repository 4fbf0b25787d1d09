// SPDX-License-Identifier: GPL-3.0-or-later
// R3, R4, R5, R6: bodies that roll and slide on planes.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

void tighten_rolling(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-12;
  request.overrides.atol = 1e-13;
}

double spread_of(const FinishedRun& run, const std::string& name) {
  double worst = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i)
    worst = std::max(worst, std::abs(run.rows.at(i, name) - run.rows.at(0, name)));
  return worst;
}

}  // namespace

TEST_CASE("rolling: R3: the sphere gains (5/7) g sin(b)/R t about E2 alone, eq. (8.85), and the plane gives (8.82)") {
  const FinishedRun run = run_model("R3_sphere_on_incline", tighten_rolling);
  const double R = run.parameter("R"), m = run.parameter("m"), down = run.parameter("g") * std::sin(run.parameter("b"));
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i], W2 = -2 + 5 * down * t / (7 * R);
    CHECK(run.rows.at(i, "W1") == doctest::Approx(1).epsilon(1e-9));
    CHECK(run.rows.at(i, "W2") == doctest::Approx(W2).epsilon(1e-9).scale(1));
    CHECK(run.rows.at(i, "W3") == doctest::Approx(3).epsilon(1e-9));
    CHECK(run.rows.at(i, "x1") == doctest::Approx(R * (-2 * t + 5 * down * t * t / (14 * R))).epsilon(1e-9).scale(0.1));
    CHECK(run.rows.at(i, "x2") == doctest::Approx(-R * t).epsilon(1e-9).scale(0.1));
    CHECK(run.rows.at(i, "reaction.contact.1") == doctest::Approx(-2 * m * down / 7).epsilon(1e-9));
    CHECK(run.rows.at(i, "reaction.contact.2") == doctest::Approx(0).epsilon(1e-9).scale(1));
    CHECK(run.rows.at(i, "reaction.contact.3") ==
          doctest::Approx(m * run.parameter("g") * std::cos(run.parameter("b"))).epsilon(1e-9));
  }
  CHECK(run.drift("energy") < 1e-10);
}

// v = W E3 x x + R w x E3 at the start; then vdot = (2/7) W E3 x v.
TEST_CASE("rolling: R4: on a turntable the centre circles at 2/7 of its rate") {
  const FinishedRun run = run_model("R4_turntable", tighten_rolling);
  const double W = run.parameter("W"), R = run.parameter("R"), rate = 2 * W / 7;
  const double v1 = W * 0.1 + R * 5, v2 = W * 0.3 - R * 2;
  double worst = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double s = std::sin(rate * run.rows.t[i]) / rate, c = (1 - std::cos(rate * run.rows.t[i])) / rate;
    worst = std::max({worst, std::abs(run.rows.at(i, "x1") - (0.3 + v1 * s - v2 * c)),
                      std::abs(run.rows.at(i, "x2") - (-0.1 + v2 * s + v1 * c))});
  }
  CHECK(worst < 1e-9);
  CHECK(run.rows.t.back() * rate > 2 * 3.1415);  // more than one turn
}

TEST_CASE("rolling: R5: Chaplygin's sphere conserves energy and the angular momentum about the point of contact") {
  const FinishedRun run = run_model("R5_chaplygin_sphere", tighten_rolling);
  CHECK(run.drift("energy") < 1e-10);
  for (const char* name : {"HP1", "HP2", "HP3"}) CHECK(spread_of(run, name) < 1e-10);
  CHECK(spread_of(run, "ball.omega1") > 0.5);
}

TEST_CASE("rolling: R6: the constraints are (9.79), two not integrable and one that is") {
  DisplayedModel r6("R6_rolling_disk");
  const mechanics::Mechanics& m = r6.s.mechanics;
  REQUIRE(m.constraints.size() == 3);
  CHECK(m.constraints[0].kind == mechanics::ConstraintKind::velocity);
  CHECK(m.constraints[1].kind == mechanics::ConstraintKind::velocity);
  CHECK(m.constraints[2].kind == mechanics::ConstraintKind::holonomic);
  CHECK(m.classification[0].integrable == mechanics::Integrability::no);
  CHECK(m.classification[1].integrable == mechanics::Integrability::no);
  CHECK(m.classification[2].integrable == mechanics::Integrability::yes);
  const reading::DisplayForm form = r6.form(system::Approach::one);
  const Sum phi = r6("phi"), theta = r6("theta"), R = r6("R"), dphi = r6("phi_dot"), dtheta = r6("theta_dot"),
            dpsi = r6("psi_dot");
  const Sum roll = dpsi + dphi * cos(theta), tip = dtheta * sin(theta);
  CHECK(same(form.constraints[0].rate, r6("x1_dot") + R * (roll * cos(phi) - tip * sin(phi))));
  CHECK(same(form.constraints[1].rate, r6("x2_dot") + R * (roll * sin(phi) + tip * cos(phi))));
  CHECK(same(form.constraints[2].psi, r6("x3") - R * sin(theta)));
}

TEST_CASE("rolling: R6: the disk conserves energy to 1e-10 over 100 s") {
  const FinishedRun run =
      run_model("R6_rolling_disk", [](pipeline::SimulationRequest& request) { request.scene = "long"; });
  CHECK(run.simulation.result.solver == "dop853");
  CHECK(run.simulation.result.t == 100);
  CHECK(run.drift("energy") < 1e-10);
}

// Euler's equations about the centre along e1', e2'', e3 with the force of the plane from Newton's: of theta, its rate,
// w2 = phi_dot sin(theta) and w3 alone.
TEST_CASE("rolling: R6: the disk agrees with a separate integration of Newton's and Euler's equations") {
  const FinishedRun run = run_model("R6_rolling_disk", tighten_rolling);
  const double m = run.parameter("m"), R = run.parameter("R"), g = run.parameter("g"), J = m * R * R / 4,
               J3 = m * R * R / 2;
  using State = std::array<double, 4>;
  const auto rate = [&](const State& x) {
    const auto [theta, dtheta, w2, w3] = x;
    const double W3 = w2 / std::tan(theta);
    return State{dtheta, (J * W3 * w2 - (J3 + m * R * R) * w2 * w3 - m * g * R * std::cos(theta)) / (J + m * R * R),
                 dtheta * (J3 * w3 - J * W3) / J, m * R * R * dtheta * w2 / (J3 + m * R * R)};
  };
  State x{1.2, 0, 0.5 * std::sin(1.2), 8 + 0.5 * std::cos(1.2)};
  constexpr int steps = 20000;  // of the classical Runge-Kutta method: errors of 1e-12
  const double h = 10.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const auto moved = [&](const State& k, double by) {
      State y = x;
      for (std::size_t c = 0; c < 4; ++c) y[c] += by * k[c];
      return y;
    };
    const State a = rate(x), b = rate(moved(a, h / 2)), c = rate(moved(b, h / 2)), d = rate(moved(c, h));
    for (std::size_t k = 0; k < 4; ++k) x[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  CHECK(run.final("theta") == doctest::Approx(x[0]).epsilon(1e-9));
  CHECK(run.final("theta_dot") == doctest::Approx(x[1]).epsilon(1e-8).scale(1));
  CHECK(run.final("disk.omega3") == doctest::Approx(x[3]).epsilon(1e-9));
}

TEST_CASE("rolling: R6: on ice the disk conserves energy, spin, and the horizontal velocity of its centre") {
  const FinishedRun run = run_model("R6_sliding_disk", tighten_rolling);
  CHECK(run.drift("energy") < 1e-11);
  CHECK(spread_of(run, "x1_dot") < 1e-11);
  CHECK(spread_of(run, "x2_dot") < 1e-11);
  CHECK(spread_of(run, "disk.omega3") < 1e-9);
  CHECK(std::abs(run.final("x3") - 0.2 * std::sin(run.final("theta"))) < 1e-12);
}
