// SPDX-License-Identifier: GPL-3.0-or-later
// R16: bodies on one another; a rod and a sphere that can leave the plane.
#include <doctest/doctest.h>

#include <array>

#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

// z_ddot of the lower end is 0 with forces (F, N) at it, which turn the rod by L/2 (F s - N c).
struct Rod {
  explicit Rod(const FinishedRun& run)
      : m(run.parameter("m")), L(run.parameter("L")), g(run.parameter("g")), mu(run.parameter("mu")) {}
  double factor(double theta, double way) const {
    return 1 + 3 * std::cos(theta) * (std::cos(theta) + mu * way * std::sin(theta));
  }
  double normal(double theta, double spin, double way) const {
    return (m * g - m * L / 2 * spin * spin * std::sin(theta)) / factor(theta, way);
  }
  /// x, theta and their rates, sliding backwards.
  void rates(const double* x, double* dx) const {
    const double N = normal(x[1], x[3], -1), F = mu * N;
    dx[0] = x[2], dx[1] = x[3], dx[2] = F / m;
    dx[3] = 6 / (m * L) * (F * std::sin(x[1]) - N * std::cos(x[1]));
  }
  double m, L, g, mu;
};

}  // namespace

TEST_CASE("bodies_in_contact: the rod at the critical slope: below mu = 4/3 it slides as the balances by hand say") {
  const FinishedRun run = run_rough("painleve_rod", "default",
                                    [](pipeline::SimulationRequest& request) { request.overrides.every = 0.002; });
  const Rod rod(run);
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.rows.at(0, "reaction.end") == doctest::Approx(rod.m * rod.g / (1.6 - 1.2 * rod.mu)).epsilon(rounding));
  HandWrittenMotion hand([&](double, const double* x, double* dx) { rod.rates(x, dx); }, 0, {0, std::atan(2.0), -5, 0});
  std::size_t i = 1;
  for (; run.rows.t[i] < (events_of(run).empty() ? 0.2 : events_of(run)[0].t - 1e-3); ++i) {
    hand.advance_to(run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "x") - hand.x[0]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta") - hand.x[1]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta_dot") - hand.x[3]) < 1e-9);  // of some 100 rad/s
    CHECK(run.rows.at(i, "reaction.end") == doctest::Approx(rod.normal(hand.x[1], hand.x[3], -1)).epsilon(1e-8));
  }
  REQUIRE(i > 3);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE(
    "bodies_in_contact: the rod at the critical slope: 4/3 is where no force obeys the law any more, from both sides") {
  const auto at = [](const char* scene, double mu) {
    return run_rough("painleve_rod", scene, [mu](pipeline::SimulationRequest& request) {
      with({{"mu", mu}})(request);
      request.overrides.t_end = 1e-9;
    });
  };
  CHECK(run_rough("painleve_rod", "above").simulation.result.outcome == eom::Outcome::friction_no_solution);
  CHECK(at("default", 4.0 / 3 * (1 + 1e-9)).simulation.result.outcome == eom::Outcome::friction_no_solution);
  const FinishedRun below = at("default", 4.0 / 3 * (1 - 1e-6));
  CHECK(below.rows.at(0, "reaction.end") ==
        doctest::Approx(below.parameter("m") * below.parameter("g") / 1.6e-6).epsilon(1e-6));
}

TEST_CASE(
    "bodies_in_contact: the rod that turns fast: above 4/3 pressing and leaving both obey the law, below it leaves") {
  CHECK(run_rough("painleve_rod", "several").simulation.result.outcome == eom::Outcome::friction_many_solutions);
  const FinishedRun leaves =
      run_rough("painleve_rod", "leaves", [](pipeline::SimulationRequest& request) { request.overrides.t_end = 0.05; });
  const Rod rod(leaves);
  CHECK(rod.normal(std::atan(2.0), 10, -1) < 0);
  REQUIRE(!events_of(leaves).empty());
  CHECK(events_of(leaves)[0].kind == "lose_contact");
  CHECK(events_of(leaves)[0].t == 0);
  // In flight: the centre falls, the turning stays.
  const double z = rod.L / 2 * std::sin(std::atan(2.0)), up = rod.L / 2 * 10 * std::cos(std::atan(2.0));
  CHECK(std::abs(leaves.final("z") - (z + up * 0.05 - rod.g / 2 * 0.0025)) < integration_tolerance);
  CHECK(std::abs(leaves.final("theta") - (std::atan(2.0) + 0.5)) < integration_tolerance);
  CHECK(std::abs(leaves.final("x") + 0.25) < integration_tolerance);
}

TEST_CASE(
    "bodies_in_contact: the sphere keeps its spin in every bounce, slides when they have accumulated, and rolls when "
    "slip has ended") {
  const FinishedRun run = run_rough("bouncing_sphere");
  const double g = run.parameter("g"), e = run.parameter("e"), mu = run.parameter("mu_d"), R = run.parameter("R"),
               first = std::sqrt(2 / g);
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(events.size() > 15);
  CHECK(std::abs(events[0].t - first) < integration_tolerance);
  CHECK(std::abs(events[1].t - first * (1 + 2 * e)) < integration_tolerance);
  const double zeno = first * (1 + e) / (1 - e), slip = 3 + 10 * R, rolls = zeno + slip / (3.5 * mu * g),
               v = 3 - mu * g * (rolls - zeno);
  CHECK(events.back().kind == "roll");
  CHECK(std::abs(events.back().t - rolls) < 1e-7);  // the bounces are cut at 1e-7 of the first
  CHECK(std::abs(run.final("x_dot") - v) < 1e-8);
  CHECK(std::abs(run.final("theta_dot") * R - run.final("x_dot")) < 1e-13);
  for (std::size_t i = 0; i < run.rows.size() && run.rows.t[i] < zeno - 1e-3; ++i)
    CHECK(run.rows.at(i, "theta_dot") == -10);
}

// With q = 1 - 1/(3 + 2 m/M): v^2 = 2 q g (R + S)(sin(alpha0) - sin(alpha)), N = m g sin(alpha) - m v^2/(R + S).
TEST_CASE(
    "bodies_in_contact: R16: the disk rolls on the disk that turns until friction gives way at the angle of the closed "
    "form") {
  const FinishedRun run = run_rough("R16_disk_on_disk");
  const double m = run.parameter("m"), M = run.parameter("M"), R = run.parameter("R"), S = run.parameter("S"),
               g = run.parameter("g"), k = 3 + 2 * m / M, q = 1 - 1 / k;
  REQUIRE(events_of(run).size() >= 2);
  CHECK(events_of(run)[0].kind == "slip");
  CHECK(events_of(run)[1].kind == "lose_contact");
  const auto N = [&](double alpha) { return m * g * ((1 + 2 * q) * std::sin(alpha) - 2 * q * std::sin(1.7)); };
  const auto F = [&](double alpha) { return -m * g * std::cos(alpha) / k; };
  const auto speed = [&](double alpha) { return std::sqrt(2 * q * g / (R + S) * (std::sin(1.7) - std::sin(alpha))); };
  const double slips = root_between([&](double a) { return F(a) - run.parameter("mu_s") * N(a); }, 1.7, 2.6);
  // The time from u = (alpha - 1.7)^(1/2), without its singular start.
  const double time = simpson(
      [&](double u) {
        return u == 0 ? 2 / std::sqrt(-2 * q * g / (R + S) * std::cos(1.7)) : 2 * u / speed(1.7 + u * u);
      },
      0, std::sqrt(slips - 1.7), 400);
  CHECK(std::abs(events_of(run)[0].t - time) < 1e-9);
  for (std::size_t i = 1; i < run.rows.size() && run.rows.t[i] < events_of(run)[0].t; ++i) {
    const double alpha = run.rows.at(i, "alpha"), dot = run.rows.at(i, "alpha_dot");
    CHECK(dot == doctest::Approx(speed(alpha)).epsilon(1e-9));
    CHECK(run.rows.at(i, "reaction.contact.3") == doctest::Approx(N(alpha)).epsilon(1e-9));
    CHECK(std::abs(run.rows.at(i, "reaction.contact.2")) == doctest::Approx(F(alpha)).epsilon(1e-9));
    CHECK(run.rows.at(i, "reaction.contact.1") == 0);
    CHECK(std::abs(R * run.rows.at(i, "theta_dot") + S * run.rows.at(i, "phi_dot") - (R + S) * dot) < 1e-12);
    CHECK(run.rows.at(i, "phi_dot") * M * S ==
          doctest::Approx(run.rows.at(i, "theta_dot") * m * R).epsilon(1e-9));  // one force turns both
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

namespace {

using V = std::array<double, 3>;
V operator+(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V operator*(double k, const V& a) { return {k * a[0], k * a[1], k * a[2]}; }
double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
V part(const double* x) { return {x[0], x[1], x[2]}; }

/// x = (n, u, w, W): of u = v_A - v_B = d n_dot = (R w + S W) x n follow K n-wise from -|u|^2/d, across n from (R w + S
/// W) x n_dot.
struct Spheres {
  V force(const double* x) const {
    const V n = part(x), u = part(x + 3), turn = R * part(x + 6) + S * part(x + 9);
    const V wanted = (1 / d) * cross(turn, u), across = wanted + (-dot(wanted, n)) * n;
    return (-dot(u, u) / d * reduced) * n + (1 / (1 / reduced + 2.5 / m + 2.5 / M)) * across;
  }
  void rates(const double* x, double* dx) const {
    const V n = part(x), K = force(x), moment = cross(n, K);
    for (std::size_t k = 0; k < 3; ++k) {
      dx[k] = x[3 + k] / d;
      dx[3 + k] = K[k] / reduced;
      dx[6 + k] = -2.5 / (m * R) * moment[k];
      dx[9 + k] = -2.5 / (M * S) * moment[k];
    }
  }
  double m, M, R, S, d = R + S, reduced = m * M / (m + M);
};

}  // namespace

TEST_CASE("bodies_in_contact: R16: two spheres roll on one another as Newton's and Euler's equations by hand say") {
  const FinishedRun run = run_rough("R16_sphere_on_sphere");
  const mechanics::Mechanics& mech = run.simulation.derived->mechanics;
  REQUIRE(mech.constraints.size() == 3);
  CHECK(mech.classification[0].integrable == mechanics::Integrability::no);
  CHECK(mech.classification[1].integrable == mechanics::Integrability::no);
  CHECK(mech.classification[2].integrable == mechanics::Integrability::yes);
  const Spheres spheres{run.parameter("m"), run.parameter("M"), run.parameter("R"), run.parameter("S")};
  const auto own = [&](std::size_t row, const std::string& body,
                       const char* angles) {  // w of a body along E1 E2 E3, 3-2-1 angles
    const auto at = [&](const std::string& name) { return run.rows.at(row, name); };
    const double a = at(std::string(angles) + "1"), b = at(std::string(angles) + "2"),
                 c = at(std::string(angles) + "3");
    const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b), cc = std::cos(c),
                 sc = std::sin(c);
    const V e1{ca * cb, sa * cb, -sb}, e2{ca * sb * sc - sa * cc, sa * sb * sc + ca * cc, cb * sc},
        e3{ca * sb * cc + sa * sc, sa * sb * cc - ca * sc, cb * cc};
    return at(body + ".omega1") * e1 + at(body + ".omega2") * e2 + at(body + ".omega3") * e3;
  };
  const auto state = [&](std::size_t row) {
    const auto at = [&](const std::string& name) { return run.rows.at(row, name); };
    std::vector<double> x;
    for (int k = 1; k <= 3; ++k)
      x.push_back((at("A.position" + std::to_string(k)) - at("y" + std::to_string(k))) / spheres.d);
    for (int k = 1; k <= 3; ++k)
      x.push_back(at("A.velocity" + std::to_string(k)) - at("y" + std::to_string(k) + "_dot"));
    for (const V& w : {own(row, "A", "a"), own(row, "B", "b")}) x.insert(x.end(), w.begin(), w.end());
    return x;
  };
  HandWrittenMotion hand([&](double, const double* x, double* dx) { spheres.rates(x, dx); }, 0, state(0));
  const V turn = spheres.R * part(hand.x.data() + 6) + spheres.S * part(hand.x.data() + 9),
          u = cross(turn, part(hand.x.data()));
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(u[k] - hand.x[3 + k]) < 1e-12);  // rolls
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    hand.advance_to(run.rows.t[i]);
    const std::vector<double> x = state(i);
    for (std::size_t k = 0; k < x.size(); ++k)
      CHECK(std::abs(x[k] - hand.x[k]) < 1e-9);  // angular velocities of some 5 rad/s
    CHECK(run.rows.at(i, "reaction.contact.3") ==
          doctest::Approx(dot(spheres.force(hand.x.data()), part(hand.x.data()))).epsilon(1e-8));
  }
  CHECK(run.drift("energy") < 1e-10);
}
