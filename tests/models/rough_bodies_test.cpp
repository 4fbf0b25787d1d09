// SPDX-License-Identifier: GPL-3.0-or-later
// R3, R4, R6 with friction: bodies that slide until they roll, and roll until friction gives way.
#include <doctest/doctest.h>

#include <array>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Incline {
  explicit Incline(const FinishedRun& run)
      : R(run.parameter("R")),
        mg(run.parameter("m") * run.parameter("g") * std::cos(run.parameter("b"))),
        down(run.parameter("g") * std::sin(run.parameter("b"))),
        drag(run.parameter("mu_d") * run.parameter("g") * std::cos(run.parameter("b"))),
        mu_d(run.parameter("mu_d")),
        mu_s(run.parameter("mu_s")),
        b(run.parameter("b")) {}
  double R, mg, down, drag, mu_d, mu_s, b;
};

}  // namespace

TEST_CASE("rough_bodies: R3: thrown down without spin the sphere slides until friction has made it roll") {
  const FinishedRun run = run_rough("R3_rough_incline", "thrown");
  const Incline k(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "roll");
  CHECK(events_of(run)[0].name == "contact");
  // The point of contact slows down by (7/2) mu_d g cos b - g sin b.
  const double t = 3 / (3.5 * k.drag - k.down), x = 3 * t + (k.down - k.drag) * t * t / 2,
               v = 3 + (k.down - k.drag) * t, left = 2 - t;
  CHECK(std::abs(events_of(run)[0].t - t) < 1e-12);
  CHECK(std::abs(run.final("x_dot") - (v + 5 * k.down / 7 * left)) < integration_tolerance);
  CHECK(std::abs(run.final("x") - (x + v * left + 5 * k.down / 14 * left * left)) < integration_tolerance);
  CHECK(std::abs(run.final("theta_dot") * k.R - run.final("x_dot")) < 1e-13);
  CHECK(run.final("reaction.contact.1") == doctest::Approx(-2 * run.parameter("m") * k.down / 7).epsilon(rounding));
  CHECK(run.final("reaction.contact.2") == 0);
  CHECK(run.final("reaction.contact.3") == doctest::Approx(k.mg).epsilon(rounding));
  CHECK(run.rows.at(1, "reaction.contact.1") == doctest::Approx(-k.mu_d * k.mg).epsilon(rounding));
  CHECK(run.simulation.result.power_balance < 1e-12);
}

TEST_CASE("rough_bodies: R3: with forward spin up the incline friction drives the sphere down until it rolls") {
  const FinishedRun run = run_rough("R3_rough_incline", "backspin");
  const Incline k(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "roll");
  const double t = 5 / (3.5 * k.drag + k.down), v = -1 + (k.down + k.drag) * t;
  CHECK(std::abs(events_of(run)[0].t - t) < 1e-12);
  CHECK(std::abs(run.final("x_dot") - (v + 5 * k.down / 7 * (2 - t))) < integration_tolerance);
  CHECK(run.rows.at(1, "mode.contact") == -1);
}

TEST_CASE("rough_bodies: R3: rolling persists if and only if mu_s >= (2/7) tan(b)") {
  const FinishedRun rolling = run_rough("R3_rough_incline");
  const Incline k(rolling);
  CHECK(rolling.rows.at(0, "x_dot") == doctest::Approx(5 * k.R).epsilon(rounding));  // follows from rolling
  CHECK(events_of(rolling).empty());
  CHECK(std::abs(rolling.final("x_dot") - (0.5 + 10 * k.down / 7)) < integration_tolerance);
  const double limit = 2 * std::tan(k.b) / 7;
  CHECK(events_of(run_rough("R3_rough_incline", "default", with({{"mu_s", limit * (1 + 1e-12)}, {"mu_d", 0.05}})))
            .empty());
  const FinishedRun over =
      run_rough("R3_rough_incline", "default", with({{"mu_s", limit * (1 - 1e-12)}, {"mu_d", 0.05}}));
  REQUIRE(events_of(over).size() == 1);
  CHECK(events_of(over)[0].kind == "slip");
  CHECK(events_of(over)[0].t == 0);
  CHECK(std::abs(over.final("x_dot") - (0.5 + 2 * k.down * (1 - 0.05 / std::tan(k.b)))) < integration_tolerance);
}

TEST_CASE("rough_bodies: R3: rolling at the start of an incline that is too steep it slips at once, by (8.74)") {
  const FinishedRun run = run_rough("R3_rough_incline", "steep");
  const Incline k(run);
  CHECK(k.mu_s < 2 * std::tan(k.b) / 7);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "slip");
  CHECK(events_of(run)[0].t == 0);
  CHECK(std::abs(run.final("x") - (1 + 2 * (k.down - k.drag))) < integration_tolerance);
  CHECK(std::abs(run.final("slip.contact") - 2 * (k.down - 3.5 * k.drag)) < integration_tolerance);
  CHECK(std::abs(run.final("theta_dot") - (5 + 5 * k.drag / k.R)) < 1e-9);  // of some 70 rad/s
}

// The slip velocity obeys that of a puck with mu = (7/2) mu_d: its stop is the closed form of rough_incline_puck.
// Elsewhere v - (2/7) w has the acceleration (5/7) g sin b alone.
TEST_CASE("rough_bodies: R3: thrown across the incline the sphere starts to roll as in the closed form") {
  const FinishedRun run = run_rough("R3_rough_sphere");
  const Incline k(run);
  const double w1 = -0.5 - 3 * k.R, w2 = 1.5 + 4 * k.R, w0 = std::hypot(w1, w2), ratio = 3.5 * k.mu_d / std::tan(k.b),
               psi = std::atan2(w2, w1);
  REQUIRE(ratio > 1);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "roll");
  const double t = w0 * (ratio + std::cos(psi)) / (k.down * (ratio * ratio - 1));
  CHECK(std::abs(events_of(run)[0].t - t) < integration_tolerance);
  const double v1 = -0.5 + 5 * k.down * t / 7 - 2 * w1 / 7, v2 = 1.5 - 2 * w2 / 7;
  CHECK(std::abs(run.final("x1_dot") - (v1 + 5 * k.down / 7 * (2 - t))) < integration_tolerance);
  CHECK(std::abs(run.final("x2_dot") - v2) < integration_tolerance);
  CHECK(std::abs(run.final("W1") + v2 / k.R) < 1e-9);  // of some 10 rad/s
  CHECK(std::abs(run.final("W3") - 2) < integration_tolerance);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE(
    "rough_bodies: R3: a sphere that rolls aslant goes on rolling, and one at rest on a steep incline slides straight "
    "down") {
  const FinishedRun rolling = run_rough("R3_rough_sphere", "rolling");
  CHECK(events_of(rolling).empty());
  CHECK(std::abs(rolling.final("x2_dot") + 0.1) < integration_tolerance);
  CHECK(std::abs(rolling.final("x1_dot") - (0.3 + 10 * Incline(rolling).down / 7)) < integration_tolerance);
  const FinishedRun steep = run_rough("R3_rough_sphere", "steep");
  const Incline k(steep);
  REQUIRE(!events_of(steep).empty());
  CHECK(events_of(steep)[0].kind == "slip");
  CHECK(std::abs(steep.final("x1_dot") - 2 * (k.down - k.drag)) < integration_tolerance);
  CHECK(std::abs(steep.final("slip.contact.1") - 2 * (k.down - 3.5 * k.drag)) < integration_tolerance);
}

// Of the centre v_dot = F/m, of the slip w_dot = (7/2) F/m - W E3 x v, F = -mu_d m g w/|w|.
TEST_CASE(
    "rough_bodies: R4: on a rough turntable the sphere slides as the balances by hand say, then circles at 2/7 of the "
    "rate") {
  const FinishedRun run = run_rough("R4_rough_turntable");
  const double W = run.parameter("W"), drag = run.parameter("mu_d") * run.parameter("g");
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "roll");
  const double stop = events_of(run)[0].t;
  HandWrittenMotion hand(
      [&](double, const double* x, double* dx) {
        const double s = std::hypot(x[4], x[5]), a1 = -drag * x[4] / s, a2 = -drag * x[5] / s;
        dx[0] = x[2], dx[1] = x[3], dx[2] = a1, dx[3] = a2;
        dx[4] = 3.5 * a1 + W * x[3], dx[5] = 3.5 * a2 - W * x[2];
      },
      0, {0.3, -0.1, 0, 0, -W * 0.1, -W * 0.3});
  std::size_t i = 1;
  for (; run.rows.t[i] < stop - 1e-3; ++i) {
    hand.advance_to(run.rows.t[i]);
    for (const auto& [k, name] :
         {std::pair{0, "x1"}, {1, "x2"}, {2, "x1_dot"}, {3, "x2_dot"}, {4, "slip.contact.1"}, {5, "slip.contact.2"}}) {
      CHECK(std::abs(run.rows.at(i, name) - hand.x[static_cast<std::size_t>(k)]) < integration_tolerance);
    }
  }
  REQUIRE(i > 5);
  const double rate = 2 * W / 7;
  std::size_t first = i;
  while (run.rows.t[first] <= stop) ++first;
  const double v1 = run.rows.at(first, "x1_dot"), v2 = run.rows.at(first, "x2_dot");
  for (std::size_t k = first; k < run.rows.size(); ++k) {
    const double s = std::sin(rate * (run.rows.t[k] - run.rows.t[first])) / rate,
                 c = (1 - std::cos(rate * (run.rows.t[k] - run.rows.t[first]))) / rate;
    CHECK(std::abs(run.rows.at(k, "x1") - (run.rows.at(first, "x1") + v1 * s - v2 * c)) < integration_tolerance);
    CHECK(std::abs(run.rows.at(k, "x2") - (run.rows.at(first, "x2") + v2 * s + v1 * c)) < integration_tolerance);
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

// With too little friction for the circle it goes on sliding, and never rolls faster than mu_s g = (2/7) W |v| allows.
TEST_CASE("rough_bodies: R4: on a slippery turntable the sphere never rolls") {
  const FinishedRun run = run_rough("R4_rough_turntable", "default", with({{"mu_s", 0.005}, {"mu_d", 0.005}}));
  CHECK(events_of(run).empty());
  CHECK(run.final("mode.contact") == 1);
}

namespace {

/// Newton's and Euler's equations of the disk that slides, along e1', e2'', e3: x1, x2, v1, v2, phi, theta, w1, w2, w3.
struct Disk {
  explicit Disk(const FinishedRun& run)
      : m(run.parameter("m")), R(run.parameter("R")), g(run.parameter("g")), mu(run.parameter("mu_d")) {}
  std::array<double, 2> slip(const double* x) const {
    const double cp = std::cos(x[4]), sp = std::sin(x[4]), along = R * x[8], across = R * x[6] * std::sin(x[5]);
    return {x[2] + along * cp - across * sp, x[3] + along * sp + across * cp};
  }
  void rates(const double* x, double* dx) const {
    const double J = m * R * R / 4, J3 = m * R * R / 2, cp = std::cos(x[4]), sp = std::sin(x[4]), c = std::cos(x[5]),
                 s = std::sin(x[5]);
    const auto [u1, u2] = slip(x);
    const double speed = std::hypot(u1, u2), d1 = u1 / speed, d2 = u2 / speed, turn = x[7] / s, W3 = turn * c;
    // K3 = N share along e3, m R (cos theta theta_ddot - w1^2 sin theta) = N - m g
    const double share = c + mu * s * (-d1 * sp + d2 * cp), own = (J * x[7] * W3 - J3 * x[8] * x[7]) / J;
    const double N = (m * g + m * R * (c * own - x[6] * x[6] * s)) / (1 + m * R * R * c * share / J);
    dx[0] = x[2], dx[1] = x[3], dx[2] = -mu * N * d1 / m, dx[3] = -mu * N * d2 / m, dx[4] = turn, dx[5] = x[6];
    dx[6] = own - R * N * share / J;
    dx[7] = (J3 * x[8] * x[6] - J * x[6] * W3) / J;
    dx[8] = -R * mu * N * (d1 * cp + d2 * sp) / J3;
  }
  double m, R, g, mu;
};

}  // namespace

TEST_CASE(
    "rough_bodies: R6: the disk that is pushed along slides as Newton's and Euler's equations by hand say, until it "
    "rolls") {
  const FinishedRun run = run_rough("R6_rough_disk", "thrown");
  const Disk disk(run);
  REQUIRE(!events_of(run).empty());
  CHECK(events_of(run)[0].kind == "roll");
  const double stop = events_of(run)[0].t;
  HandWrittenMotion hand([&](double, const double* x, double* dx) { disk.rates(x, dx); }, 0,
                         {0, 0, 2, 0, 0, 1.2, 0, 0, 0});
  std::size_t i = 1;
  for (; run.rows.t[i] < stop - 1e-3; ++i) {
    hand.advance_to(run.rows.t[i]);
    const auto [u1, u2] = disk.slip(hand.x.data());
    CHECK(std::abs(run.rows.at(i, "x1") - hand.x[0]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "x2_dot") - hand.x[3]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta") - hand.x[5]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "disk.omega3") - hand.x[8]) < 1e-9);  // of some 10 rad/s
    CHECK(std::abs(run.rows.at(i, "slip.contact.1") - u1) < 1e-9);
    CHECK(std::abs(run.rows.at(i, "slip.contact.2") - u2) < 1e-9);
  }
  REQUIRE(i > 20);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("rough_bodies: R6: the disk rolls as without friction until the plane cannot hold it, and slips there") {
  const FinishedRun run = run_rough("R6_rough_disk");
  const FinishedRun held = run_rough("R6_rolling_disk", "default",
                                     [](pipeline::SimulationRequest& request) { request.overrides.t_end = 2; });
  REQUIRE(events_of(run).size() == 2);
  CHECK(events_of(run)[0].kind == "slip");
  CHECK(events_of(run)[1].kind == "roll");
  const double slips = events_of(run)[0].t, mu = run.parameter("mu_s");
  bool passed = false;
  for (std::size_t i = 0; i < held.rows.size(); ++i) {
    const auto force = [&](const FinishedRun& f, std::size_t row, const char* k) {
      return f.rows.at(row, std::string("reaction.contact.") + k);
    };
    const bool holds = std::hypot(force(held, i, "1"), force(held, i, "2")) <= mu * force(held, i, "3");
    if (held.rows.t[i] > slips) {
      passed = passed || !holds;
      break;
    }
    CHECK(holds);
    REQUIRE(std::abs(run.rows.t[i] - held.rows.t[i]) < 1e-12);
    CHECK(std::abs(run.rows.at(i, "theta") - held.rows.at(i, "theta")) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "x1") - held.rows.at(i, "x1")) < integration_tolerance);
    for (const char* k : {"1", "2", "3"}) CHECK(std::abs(force(run, i, k) - force(held, i, k)) < 1e-9);
  }
  CHECK(passed);
  CHECK(run.simulation.result.power_balance < 1e-9);
}
