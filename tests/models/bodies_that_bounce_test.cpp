// SPDX-License-Identifier: GPL-3.0-or-later
// Satellites on a tether, a tippe top and a column of balls, against equations by hand. Numbers called "computed apart"
// are from a program of its own with DOP853 at 1e-13.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>

#include "models/contact_runs.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

/// B relative to A, with Encke's difference of gravity: the distance is known to its own rounding.
struct Satellites {
  explicit Satellites(const FinishedRun& run)
      : m_A(run.parameter("m_A")), m_B(run.parameter("m_B")), mu(run.parameter("mu")), L(run.parameter("L")) {}

  /// x = (A, A', r, r'), two components each.
  void rates(const double* x, double* dx) const {
    const double square = x[0] * x[0] + x[1] * x[1], cube = square * std::sqrt(square);
    const double q = (x[4] * (x[4] + 2 * x[0]) + x[5] * (x[5] + 2 * x[1])) / square;
    const double f = std::expm1(-1.5 * std::log1p(q));
    for (std::size_t k = 0; k < 2; ++k) {
      dx[k] = x[2 + k];
      dx[2 + k] = -mu * x[k] / cube;
      dx[4 + k] = x[6 + k];
      dx[6 + k] = -mu / cube * (x[4 + k] + f * (x[k] + x[4 + k]));
    }
  }
  double slack(const double* x) const { return L - std::hypot(x[4], x[5]); }
  /// The impulse reverses the speed along the tether, and keeps the sum of momenta.
  void bounce(std::vector<double>& x, double e) const {
    const double d = std::hypot(x[4], x[5]), u[2] = {x[4] / d, x[5] / d}, speed = u[0] * x[6] + u[1] * x[7];
    for (std::size_t k = 0; k < 2; ++k) {
      x[6 + k] -= (1 + e) * speed * u[k];
      x[2 + k] += (1 + e) * speed * u[k] * m_B / (m_A + m_B);
    }
  }
  double m_A, m_B, mu, L;
};

}  // namespace

TEST_CASE("tethered_satellites: the same eight impacts at all tolerances, at the times of relative coordinates") {
  const FinishedRun first = run_rough("tethered_satellites");
  const Satellites by_hand(first);
  const double e = first.parameter("e"), r = first.parameter("r"), rate = std::sqrt(by_hand.mu / r) / r;
  std::vector<double> times;  // of the first seven bounces
  HandWrittenMotion hand([&](double, const double* x, double* dx) { by_hand.rates(x, dx); }, 0,
                         {r, 0, 0, rate * r, by_hand.L / 2, 0, 0, rate * by_hand.L / 2});
  double t = 0;
  for (const double span : {800., 400., 120., 35., 12., 4., 1.5}) {
    // Past the impact, and back to it by bisection of the last part.
    const std::vector<double> begin = hand.x;
    const auto at = [&](double when) {
      HandWrittenMotion part([&](double, const double* x, double* dx) { by_hand.rates(x, dx); }, t, begin);
      part.advance_to(when);
      return part.x;
    };
    const auto slack = [&](double when) { return by_hand.slack(at(when).data()); };
    const double hit = root_between(slack, t + span / 4, t + span);
    hand.x = at(hit);
    by_hand.bounce(hand.x, e);
    t = hit;
    hand = HandWrittenMotion([&](double, const double* x, double* dx) { by_hand.rates(x, dx); }, t, hand.x);
    times.push_back(t);
  }
  CHECK(std::abs(times[0] - 751.8221804760686) < 1e-7);  // computed apart
  for (const double rtol : all_tolerances) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("tethered_satellites", "default", at_tolerance(rtol));
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    const std::vector<run::RunEvent> events = events_of(run);
    REQUIRE(events.size() == 8);
    for (std::size_t k = 0; k < events.size(); ++k) {
      CHECK(events[k].kind == "contact");
      // The length is known to 1e-8 m: the last speeds are 1e-4 m/s. At rtol 1e-6 steps add 2e-5 m, at the 0.04 m/s of
      // the second impact.
      if (k < times.size()) CHECK(std::abs(events[k].t - times[k]) < (rtol > 1e-7 ? 5e-4 : 5e-5));
    }
    CHECK(run.final("mode.tether") == 0);
    CHECK(run.final("reaction.tether") > 0);
    // The tether stays taut where rounding hides the bounces: within 16 units in the last place of 1.4e7 m.
    CHECK(std::abs(std::hypot(run.final("u") - run.final("x"), run.final("v") - run.final("y")) - by_hand.L) < 1e-7);
  }
}

// Without `[impacts]` the modes of the contact are unrolled: another procedure, with the same impacts.
TEST_CASE("tethered_satellites: without [impacts] the bounces end too") {
  const FinishedRun run = run_changed("tethered_satellites", "[impacts]\nlaw = \"newton\"\n", "");
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  const std::vector<run::RunEvent> events = events_of(run), expected = events_of(run_rough("tethered_satellites"));
  REQUIRE(expected.size() == 8);
  REQUIRE(events.size() >= 8);
  CHECK(events.size() <= 10);  // bounces of 1e-8 m, whose number follows from rounding
  for (std::size_t k = 0; k < events.size(); ++k) {
    CHECK(events[k].kind == "contact");
    CHECK(events[k].t < expected.back().t + 0.2);
    // As in the test above. The last flights begin with 3e-4 m/s, and a step may err by 7e-6 m.
    if (k < 7) CHECK(std::abs(events[k].t - expected[k].t) < (k < 5 ? 5e-5 : 1e-2));
  }
  CHECK(run.final("reaction.tether") > 0);
}

namespace {

using V3 = Eigen::Vector3d;

/// Newton's and Euler's equations of a body of revolution that slides on its sphere, with x = (velocity, e3, omega).
struct Top {
  explicit Top(const FinishedRun& run)
      : m(run.parameter("m")),
        A(run.parameter("A")),
        C(run.parameter("C")),
        R(run.parameter("R")),
        a(run.parameter("a")),
        g(run.parameter("g")),
        mu(run.parameter("mu")) {}

  static V3 part(const double* x) { return {x[0], x[1], x[2]}; }
  V3 arm(const V3& n) const { return a * n - R * V3::UnitZ(); }
  V3 slip(const double* x) const {
    V3 u = part(x) + part(x + 6).cross(arm(part(x + 3)));
    u(2) = 0;
    return u;
  }
  V3 momentum(const V3& n, const V3& w) const { return A * w + (C - A) * w.dot(n) * n; }
  double jellett(const double* x) const { return momentum(part(x + 3), part(x + 6)).dot(arm(part(x + 3))); }
  double normal_force(const double* x, V3& force, V3& spin_up) const {
    const V3 n = part(x + 3), w = part(x + 6), H = momentum(n, w), direction = slip(x).normalized();
    const auto turned = [&](const V3& moment) { return V3(moment / A + (1 / C - 1 / A) * n.dot(moment) * n); };
    const V3 unit_force = V3::UnitZ() - mu * direction;
    const V3 free = turned(-w.cross(H)), by_force = turned(arm(n).cross(unit_force));
    // z + a n_3 - R stays 0.
    const double N = -(-g + a * (free.cross(n) + w.cross(w.cross(n)))(2)) / (1 / m + a * by_force.cross(n)(2));
    force = N * unit_force;
    spin_up = free + N * by_force;
    return N;
  }
  void rates(const double* x, double* dx) const {
    V3 force, spin_up;
    normal_force(x, force, spin_up);
    const V3 n_dot = part(x + 6).cross(part(x + 3)), v_dot = force / m - g * V3::UnitZ();
    for (int k = 0; k < 3; ++k) dx[k] = v_dot(k), dx[3 + k] = n_dot(k), dx[6 + k] = spin_up(k);
  }
  double m, A, C, R, a, g, mu;
};

}  // namespace

TEST_CASE("tippe_top: it turns over as Newton's and Euler's equations by hand say, and keeps Jellett's quantity") {
  const FinishedRun run = run_rough("tippe_top");
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  const Top top(run);
  const V3 n(0, -std::sin(0.1), std::cos(0.1)), w(0, 0, 180);
  HandWrittenMotion hand([&](double, const double* x, double* dx) { top.rates(x, dx); }, 0,
                         {0, 0, -top.a * w.cross(n)(2), n(0), n(1), n(2), w(0), w(1), w(2)});
  const double jellett = top.jellett(hand.x.data());
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(!events.empty());
  CHECK(events[0].kind == "roll");
  double energy = run.rows.at(0, "energy");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    // All forces but those of the stem are kept by it: 1e-9 of it, 300 turns at rtol 1e-12.
    CHECK(run.rows.at(i, "jellett") == doctest::Approx(jellett).epsilon(1e-9));
    CHECK(run.rows.at(i, "energy") <= energy * (1 + 1e-11));  // friction takes energy; 1e-11: errors of steps
    energy = run.rows.at(i, "energy");
    if (run.rows.t[i] == 0 || run.rows.t[i] > 1.0) continue;
    hand.advance_to(run.rows.t[i]);
    // Angles of 30 turns and more: 1e-8 of one, with rtol 1e-12 on both sides.
    CHECK(std::abs(run.rows.at(i, "upright") - hand.x[5]) < 1e-8);
    V3 force, spin_up;
    CHECK(std::abs(run.rows.at(i, "reaction.sphere.3") / top.normal_force(hand.x.data(), force, spin_up) - 1) < 1e-7);
  }
  // Slip ends along a direction that is steady at last: the line through its last speeds meets 0 where it rolls.
  const double before = events[0].t - 1e-3, late = events[0].t - 5e-4;
  hand.advance_to(before);
  const double early_slip = top.slip(hand.x.data()).norm();
  hand.advance_to(late);
  const double late_slip = top.slip(hand.x.data()).norm();
  // The speed is not linear within 1 ms: 1e-5 s.
  CHECK(std::abs(late + late_slip * (late - before) / (early_slip - late_slip) - events[0].t) < 1e-5);
  CHECK(run.rows.at(0, "upright") > 0.99);
  CHECK(run.final("upright") < -0.7);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

namespace {

/// Balls of equal mass above one another. Contact 0 is the lowest ball with the plate.
struct Balls {
  double g, R, e;
  std::array<double, 3> z, v{};

  double gap(std::size_t i) const { return i == 0 ? z[0] - R : z[i] - z[i - 1] - 2 * R; }
  double rate(std::size_t i) const { return i == 0 ? v[0] : v[i] - v[i - 1]; }
  void hit(std::size_t i) {
    if (i == 0) {
      v[0] *= -e;
      return;
    }
    const double mean = (v[i] + v[i - 1]) / 2, half = e * rate(i) / 2;
    v[i] = mean - half, v[i - 1] = mean + half;
  }
  /// Falls until the next contact, and returns it and the time.
  std::pair<std::size_t, double> fall() {
    std::size_t next = 0;
    double time = (v[0] + std::sqrt(v[0] * v[0] + 2 * g * std::max(gap(0), 0.0))) / g;
    for (std::size_t i = 1; i < 3; ++i) {
      const double meets = rate(i) < 0 ? std::max(gap(i), 0.0) / -rate(i) : std::numeric_limits<double>::infinity();
      if (meets < time) next = i, time = meets;
    }
    for (std::size_t i = 0; i < 3; ++i) z[i] += v[i] * time - g / 2 * time * time, v[i] -= g * time;
    return {next, time};
  }
  double squares() const { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }
};

constexpr std::array<const char*, 3> contact_of_balls{"plate", "lower", "upper"};

}  // namespace

TEST_CASE("ball_chain: the first sixty impacts are those of parabolas, and the column comes to rest") {
  for (const double rtol : all_tolerances) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("ball_chain", "default", at_tolerance(rtol));
    const std::vector<run::RunEvent> events = events_of(run);
    const double m = run.parameter("m"), R = run.parameter("R");
    Balls balls{run.parameter("g"), R, run.parameter("e"), {0.3, 0.5, 0.75}};
    REQUIRE(events.size() > 60);
    double t = 0;
    for (std::size_t k = 0; k < 60; ++k) {
      CAPTURE(k);
      const auto [contact, time] = balls.fall();
      t += time;
      const double before = balls.squares();
      balls.hit(contact);
      CHECK(events[k].kind == "contact");
      CHECK(events[k].name == contact_of_balls[contact]);
      CHECK(std::abs(events[k].t - t) < integration_tolerance);  // parabolas are exact for every method
      CHECK(std::abs(events[k].work - m / 2 * (balls.squares() - before)) < 1e-11);  // of 0.2 J, times and roundings
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const double above = static_cast<double>(3 - i), number = static_cast<double>(i);
      CHECK(std::abs(run.final("z" + std::to_string(i + 1)) - (2 * number + 1) * R) < rounding);
      CHECK(std::abs(run.final("z" + std::to_string(i + 1) + "_dot")) < rounding);
      CHECK(run.final("reaction." + std::string(contact_of_balls[i])) ==
            doctest::Approx(above * m * run.parameter("g")).epsilon(rounding));
    }
    CHECK(run.simulation.result.power_balance < rounding);
  }
}

TEST_CASE("ball_chain: a ball onto two at rest loses less pair by pair than all at once") {
  const FinishedRun sequence = run_rough("ball_chain", "at_rest");
  const FinishedRun together = run_changed("ball_chain", "order = \"sequence\"", "order = \"simultaneous\"", "at_rest");
  const double m = sequence.parameter("m"), g = sequence.parameter("g"), e = sequence.parameter("e");
  Balls balls{g, sequence.parameter("R"), e, {0.05, 0.15, 0.25}};
  const double fall = 0.25, speed = std::sqrt(2 * g * fall);
  balls.v[2] = -speed;
  for (;;) {  // the fastest pair first
    std::size_t fastest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (balls.rate(i) < balls.rate(fastest)) fastest = i;
    if (balls.rate(fastest) > -1e-12) break;
    balls.hit(fastest);
  }
  const double pairs = m / 2 * (balls.squares() - speed * speed), at_once = m / 2 * (e * e - 1) * speed * speed;
  REQUIRE(!events_of(sequence).empty());
  REQUIRE(!events_of(together).empty());
  CHECK(std::abs(events_of(sequence)[0].t - std::sqrt(2 * fall / g)) < integration_tolerance);
  CHECK(events_of(sequence)[0].work == doctest::Approx(pairs).epsilon(1e-10));
  CHECK(events_of(together)[0].work == doctest::Approx(at_once).epsilon(1e-10));
}
