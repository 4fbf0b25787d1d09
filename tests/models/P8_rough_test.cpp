// SPDX-License-Identifier: GPL-3.0-or-later
// The rough helix: (2.143), (2.145) with corrected indices, and quadratures of these.
#include <doctest/doctest.h>

#include "models/displayed_model.hpp"
#include "models/rough.hpp"
#include "print/render.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Helix {
  explicit Helix(const FinishedRun& run)
      : m(run.parameter("m")),
        g(run.parameter("g")),
        R(run.parameter("R")),
        alpha(run.parameter("alpha")),
        mu_d(run.parameter("mu_d")),
        slope(1 + alpha * alpha) {}
  /// |N|: curvature along the principal normal, weight along the binormal.
  double normal(double rate) const { return m * std::hypot(R * rate * rate, g / std::sqrt(slope)); }
  /// theta_ddot while it slides with this rate.
  double acceleration(double rate) const {
    return (-g * alpha / std::sqrt(slope) - (rate > 0 ? 1 : -1) * mu_d * normal(rate) / m) / (R * std::sqrt(slope));
  }
  double m, g, R, alpha, mu_d, slope;
};

}  // namespace

TEST_CASE("P8: at random states the derived equations are (2.143), the normal force that of both constraints") {
  const FinishedRun run = run_rough("P8_rough_helix");
  const Helix h(run);
  StateEvaluation derived(run, "P8_rough_helix");
  UniformSampler draw;
  for (int i = 0; i < 50; ++i) {
    const double theta = draw(-9, 9), rate = draw(-6, 6);
    REQUIRE(derived.slide(0, {theta, rate}));
    const double dd = derived.dx[1], l1 = derived.output("reaction.wire.1"), l2 = derived.output("reaction.wire.2");
    // lambda1 a^2 + lambda2 a^3 with a^2 = e_r, a^3 = E3 - alpha theta e_r - alpha e_theta (2.129)
    const double N = std::sqrt(std::pow(l1 - h.alpha * theta * l2, 2) + std::pow(h.alpha * l2, 2) + l2 * l2);
    const double F = -h.mu_d * N * (rate > 0 ? 1 : -1) / std::sqrt(h.slope);  // Ff = F (e_theta + alpha E3)
    const double scale = 100;
    CHECK(h.m * h.slope * h.R * h.R * dd ==
          doctest::Approx(-h.m * h.g * h.alpha * h.R + F * h.R * h.slope).epsilon(rounding).scale(scale));
    CHECK(h.m * h.alpha * h.alpha * h.R * (theta * dd + rate * rate) - h.m * h.slope * h.R * rate * rate ==
          doctest::Approx(-h.m * h.g * h.alpha * theta + l1 + F * h.alpha * h.alpha * theta)
              .epsilon(rounding)
              .scale(scale));
    CHECK(h.m * h.alpha * h.R * dd == doctest::Approx(-h.m * h.g + l2 + F * h.alpha).epsilon(rounding).scale(scale));
    CHECK(derived.output("friction.wire.3") == doctest::Approx(F * h.alpha).epsilon(rounding).scale(scale));
    CHECK(N == doctest::Approx(h.normal(rate)).epsilon(rounding));
  }
}

TEST_CASE("P8: thrown up it stops at the place and time of the quadrature of (2.143), and sticks with (2.145)") {
  const FinishedRun run = run_rough("P8_rough_helix");
  const Helix h(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "stick");
  const double time = simpson([&](double w) { return -1 / h.acceleration(w + 1e-300); }, 0, 4);
  const double angle = simpson([&](double w) { return -w / h.acceleration(w + 1e-300); }, 0, 4);
  CHECK(std::abs(events_of(run)[0].t - time) < integration_tolerance);
  const double theta = run.final("theta");
  CHECK(std::abs(theta - 0.5 - angle) < integration_tolerance);
  // The components of the total force of the wire along a_1, a_2, a_3 are those of -Fa.
  const double l1 = run.final("reaction.wire.1"), l2 = run.final("reaction.wire.2");
  const double f1 = run.final("friction.wire.1"), f2 = run.final("friction.wire.2"), f3 = run.final("friction.wire.3");
  const double along_r = f1 * std::cos(theta) + f2 * std::sin(theta),
               along_theta = -f1 * std::sin(theta) + f2 * std::cos(theta);
  const double weight = h.m * h.g;
  CHECK(l1 + along_r + h.alpha * theta * f3 == doctest::Approx(weight * h.alpha * theta).epsilon(rounding));
  CHECK(l2 + f3 == doctest::Approx(weight).epsilon(rounding));
  CHECK(h.R * (along_theta + h.alpha * f3) == doctest::Approx(weight * h.alpha * h.R).epsilon(rounding));
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("P8: on a wire with too little friction it reverses and slides down by the quadrature") {
  const FinishedRun run = run_rough("P8_rough_helix", "slips");
  const Helix h(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "reverse");
  const double up = simpson([&](double w) { return -1 / h.acceleration(w + 1e-300); }, 0, 4);
  CHECK(std::abs(events_of(run)[0].t - up) < integration_tolerance);
  const double rate = run.final("theta_dot"),
               down = simpson([&](double w) { return 1 / h.acceleration(w - 1e-300); }, 0, rate);
  CHECK(std::abs(up + down - run.simulation.result.t) < integration_tolerance);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("P8: from rest it sticks if mu_s is at least alpha, and slides otherwise") {
  const double alpha = 0.3;
  CHECK(events_of(run_rough("P8_rough_helix", "rest")).empty());
  CHECK(events_of(run_rough("P8_rough_helix", "rest", with({{"mu_s", alpha * (1 + 1e-9)}}))).empty());
  for (const double mu : {alpha * (1 - 1e-9), 0.25}) {
    const FinishedRun run = run_rough("P8_rough_helix", "starts", with({{"mu_s", mu}}));
    REQUIRE(events_of(run).size() == 1);
    CHECK(events_of(run)[0].kind == "slip");
    CHECK(events_of(run)[0].t == 0);
    const Helix h(run);
    const double rate = run.final("theta_dot");
    CHECK(rate < -1);
    CHECK(std::abs(simpson([&](double w) { return 1 / h.acceleration(w - 1e-300); }, 0, rate) -
                   run.simulation.result.t) < integration_tolerance);
  }
}

TEST_CASE("P8: approach II says that it does not close with friction, since its law contains the multipliers") {
  const test::DisplayedModel model("P8_rough_helix");
  const auto reasons = [&](system::Approach approach) {
    std::string all;
    const reading::DisplayForm form = reading::derive_display_form(model.s.mechanics, approach);
    for (const print::PrintedFormula& item : print::render(model.s.mechanics, form, {"friction"})) all += item.left_out;
    return all;
  };
  CHECK(reasons(system::Approach::one).empty());
  CHECK(reasons(system::Approach::two).find("approach I gives it as a function of the motion") != std::string::npos);
}
