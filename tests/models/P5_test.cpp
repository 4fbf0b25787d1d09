// SPDX-License-Identifier: GPL-3.0-or-later
// The rough sphere of Ex 2.5 with hand-written (2.157)-(2.160): inside (psi = R0 - R), and outside (psi = R - R0,
// unilateral).
#include <doctest/doctest.h>

#include "models/displayed_model.hpp"
#include "models/rough.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Sphere {
  explicit Sphere(const FinishedRun& run)
      : m(run.parameter("m")),
        g(run.parameter("g")),
        R0(run.parameter("R0")),
        K(run.parameter("K")),
        L0(run.parameter("L0")),
        a(run.parameter("a")),
        b(run.parameter("b")),
        mu_s(run.parameter("mu_s")),
        mu_d(run.parameter("mu_d")) {}

  /// K (|x| - L) x.e/|x| along e_R, e_phi, e_theta, x = R0 e_R - a E1 - b E2.
  std::array<double, 3> spring(double phi, double theta) const {
    const double s = std::sin(phi), c = std::cos(phi), to = a * std::cos(theta) + b * std::sin(theta);
    const double across = -a * std::sin(theta) + b * std::cos(theta);
    const std::array<double, 3> x{R0 - s * to, -c * to, -across};
    const double length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), F = K * (length - L0) / length;
    return {F * x[0], F * x[1], F * x[2]};
  }
  /// (2.158): N = normal e_R.
  double normal(double phi, double theta, double dphi, double dtheta) const {
    const double s = std::sin(phi);
    return -m * R0 * (dphi * dphi + s * s * dtheta * dtheta) + m * g * std::cos(phi) + spring(phi, theta)[0];
  }
  /// (2.157), x = phi, theta and their rates.
  void rates(const double* x, double* dx) const {
    const double s = std::sin(x[0]), c = std::cos(x[0]), N = std::abs(normal(x[0], x[1], x[2], x[3]));
    const double speed = std::hypot(x[2], s * x[3]), drag = speed > 0 ? mu_d * N / speed : 0;
    const std::array<double, 3> f = spring(x[0], x[1]);
    dx[0] = x[2], dx[1] = x[3];
    dx[2] = s * c * x[3] * x[3] + (m * g * s - f[1] - drag * x[2]) / (m * R0);
    dx[3] = ((-f[2] - drag * s * x[3]) / (m * R0) - 2 * c * x[2] * x[3]) / s;
  }
  double m, g, R0, K, L0, a, b, mu_s, mu_d;
};

void sliding_is_2_157(const std::string& model, bool leaves) {
  const FinishedRun run = run_rough(model);
  const Sphere sphere(run);
  StateEvaluation derived(run, model);
  UniformSampler draw;
  int tried = 0;
  for (int i = 0; i < 80; ++i) {
    const double phi = draw(0.2, 2.9), theta = draw(-3, 3), dphi = draw(-4, 4), dtheta = draw(-4, 4);
    const double N = sphere.normal(phi, theta, dphi, dtheta);
    if (leaves && N <= 0) continue;
    ++tried;
    const std::vector<double> state = leaves ? std::vector<double>{sphere.R0, phi, theta, 0, dphi, dtheta}
                                             : std::vector<double>{phi, theta, dphi, dtheta};
    REQUIRE(derived.slide(0, state));
    const double x[4] = {phi, theta, dphi, dtheta};
    double expected[4];
    sphere.rates(x, expected);
    const std::size_t first = leaves ? 4 : 2;
    CHECK(derived.dx[first] == doctest::Approx(expected[2]).epsilon(rounding).scale(100));
    CHECK(derived.dx[first + 1] == doctest::Approx(expected[3]).epsilon(rounding).scale(100));
    CHECK(derived.output("reaction.sphere") == doctest::Approx(leaves ? N : -N).epsilon(rounding).scale(100));
  }
  CHECK(tried >= 10);
}

}  // namespace

TEST_CASE("P5: the display form equals (2.157) and (2.158) without friction, symbolically") {
  DisplayedModel p5("P5_inside_rough_sphere");
  const Sum m = p5("m"), g = p5("g"), R0 = p5("R0"), K = p5("K"), L0 = p5("L0"), a = p5("a"), b = p5("b");
  const Sum s = sin(p5("phi")), c = cos(p5("phi")), st = sin(p5("theta")), ct = cos(p5("theta"));
  const Sum dphi = p5("phi_dot"), dtheta = p5("theta_dot");
  const Sum to = a * ct + b * st, across = b * ct - a * st;
  const Sum length = sqrt(square(R0) + square(a) + square(b) - Sum(2) * R0 * s * to);
  const Sum F = K - over(K * L0, length);
  const reading::DisplayForm form = p5.form(system::Approach::one);
  CHECK(same(p5.equation(form, "phi").expanded,
             m * square(R0) * (p5("phi_ddot") - s * c * square(dtheta)) - m * g * R0 * s - F * R0 * c * to));
  CHECK(same(p5.equation(form, "theta").expanded,
             m * square(R0) * (square(s) * p5("theta_ddot") + Sum(2) * s * c * dphi * dtheta) - F * R0 * s * across));
  // lambda dpsi/dR with psi = R0 - R: N = -lambda.
  REQUIRE(form.reactions.size() == 1);
  CHECK(same(*form.reactions[0].value,
             m * R0 * (square(dphi) + square(s) * square(dtheta)) - m * g * c - F * (R0 - s * to)));
}

TEST_CASE(
    "P5: at random states friction included, inside and outside, the equations are (2.157) and the normal force is "
    "(2.158)") {
  sliding_is_2_157("P5_inside_rough_sphere", false);
  sliding_is_2_157("P5_rough_sphere", true);
}

TEST_CASE("P5: inside it slides by (2.157) until it sticks, with the friction of (2.159)") {
  const FinishedRun run = run_rough("P5_inside_rough_sphere");
  const Sphere sphere(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "stick");
  HandWrittenMotion hand([&](double, const double* x, double* dx) { sphere.rates(x, dx); }, 0, {2.2, 0.3, 0.5, 4});
  double before = run.rows.at(0, "energy");
  std::size_t compared = 0;
  for (std::size_t i = 1; i < run.rows.size() && run.rows.t[i] < events_of(run)[0].t - 0.01; ++i, ++compared) {
    hand.advance_to(run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "phi") - hand.x[0]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "theta") - hand.x[1]) < 10 * integration_tolerance);  // some 8 rad
    CHECK(run.rows.at(i, "energy") < before);                                           // decreases while it moves
    before = run.rows.at(i, "energy");
  }
  CHECK(compared > 100);
  // Fc = m g E3 + K (x - L) x/|x|; N is its component along e_R.
  const double phi = run.final("phi"), theta = run.final("theta"), N = -run.final("reaction.sphere");
  const std::array<double, 3> f = sphere.spring(phi, theta);
  const double s = std::sin(phi), c = std::cos(phi);
  const double F1 = run.final("friction.sphere.1"), F2 = run.final("friction.sphere.2"),
               F3 = run.final("friction.sphere.3");
  const double in_plane = F1 * std::cos(theta) + F2 * std::sin(theta);
  CHECK(N == doctest::Approx(sphere.m * sphere.g * c + f[0]).epsilon(rounding));
  CHECK(in_plane * c - F3 * s == doctest::Approx(-sphere.m * sphere.g * s + f[1]).epsilon(1e-11).scale(1));
  CHECK(-F1 * std::sin(theta) + F2 * std::cos(theta) == doctest::Approx(f[2]).epsilon(1e-11).scale(1));
  CHECK(std::sqrt(F1 * F1 + F2 * F2 + F3 * F3) <= sphere.mu_s * std::abs(N));
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("P5: at rest it sticks while mu_s N exceeds the tangential force, and slides otherwise") {
  const FinishedRun held = run_rough("P5_rough_sphere", "held");
  const Sphere sphere(held);
  CHECK(events_of(held).empty());
  for (std::size_t i = 0; i < held.rows.size(); ++i) {
    CHECK(std::abs(held.rows.at(i, "phi") - 0.1) < rounding);
    CHECK(std::abs(held.rows.at(i, "theta") - 0.3) < rounding);
  }
  const std::array<double, 3> f = sphere.spring(0.1, 0.3);
  const double tangential = std::hypot(sphere.m * sphere.g * std::sin(0.1) - f[1], f[2]);
  const double critical = tangential / sphere.normal(0.1, 0.3, 0, 0);
  CHECK(events_of(run_rough("P5_rough_sphere", "held", with({{"mu_s", critical * (1 + 1e-9)}}))).empty());
  const FinishedRun slides = run_rough("P5_rough_sphere", "held", with({{"mu_s", critical * (1 - 1e-9)}}));
  REQUIRE(!events_of(slides).empty());
  CHECK(events_of(slides)[0].kind == "slip");
  CHECK(events_of(slides)[0].t == 0);
}

TEST_CASE(
    "P5: it leaves the sphere where (2.158) vanishes along the hand-written motion, then flies without friction") {
  const FinishedRun run = run_rough("P5_rough_sphere");
  const Sphere sphere(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "lose_contact");
  const auto rates = [&](double, const double* x, double* dx) { sphere.rates(x, dx); };
  const auto normal_at = [&](double t) {
    HandWrittenMotion hand(rates, 0, {0.2, 0.3, 0.1, 0.5});
    hand.advance_to(t);
    return sphere.normal(hand.x[0], hand.x[1], hand.x[2], hand.x[3]);
  };
  CHECK(std::abs(events_of(run)[0].t - root_between(normal_at, 0.5, 0.8)) < integration_tolerance);
  std::size_t flying = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    if (run.rows.t[i] <= events_of(run)[0].t) continue;
    CHECK(run.rows.at(i, "R") > sphere.R0);
    CHECK(run.rows.at(i, "reaction.sphere") == 0);
    CHECK(run.rows.at(i, "mode.sphere") == 2);
    CHECK(std::abs(run.rows.at(i, "energy") - run.final("energy")) <
          integration_tolerance);  // includes the energy of the spring
    ++flying;
  }
  CHECK(flying > 10);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("P5: smooth and without spring it leaves at cos(phi) = 2/3, and inside it conserves h and (2.160)") {
  const FinishedRun outside = run_rough("P5_rough_sphere", "smooth");
  REQUIRE(events_of(outside).size() == 1);
  const double g = outside.parameter("g"), R0 = outside.parameter("R0"), leaves = std::acos(2.0 / 3);
  // phi_dot = 2 sqrt(g/R0) sin(phi/2): t = sqrt(R0/g) log tan(phi/4)
  const double time = std::sqrt(R0 / g) * std::log(std::tan(leaves / 4) / std::tan(0.1 / 4));
  CHECK(std::abs(events_of(outside)[0].t - time) < integration_tolerance);

  const FinishedRun inside = run_rough("P5_inside_rough_sphere", "smooth");
  const double h = std::pow(std::sin(2.2), 2) * 4;  // of unit m R0^2
  HandWrittenMotion hand(
      [=](double, const double* x, double* dx) {
        dx[0] = x[1];
        dx[1] = std::cos(x[0]) / std::pow(std::sin(x[0]), 3) * h * h + g / R0 * std::sin(x[0]);
      },
      0, {2.2, 0.5});
  for (std::size_t i = 1; i < inside.rows.size(); ++i) {
    hand.advance_to(inside.rows.t[i]);
    const double phi = inside.rows.at(i, "phi");
    CHECK(std::abs(std::pow(std::sin(phi), 2) * inside.rows.at(i, "theta_dot") - h) < 10 * integration_tolerance);
    CHECK(std::abs(phi - hand.x[0]) < 10 * integration_tolerance);
  }
  CHECK(inside.simulation.result.power_balance < 1e-9);
}
