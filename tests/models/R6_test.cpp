// SPDX-License-Identifier: GPL-3.0-or-later
// R6: what the source shows of the disk on a plane: its constraint force and moment (9.84), the equations by both
// approaches (9.87), (9.88), (9.93), and the two integrals that Appell, Chaplygin and Korteweg found. Motion and
// energy: rolling_test.cpp.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "models/displayed_model.hpp"
#include "print/render.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

std::string shown(const DisplayedModel& read, const reading::DisplayForm& form, const std::string& role) {
  for (const print::PrintedFormula& item : print::render(read.s.mechanics, form, {"reactions"})) {
    if (item.role == role) return item.text;
  }
  return "";
}

/// lambda's factor in the equation of a coordinate.
Sum slope(const reading::Equation& equation, std::uint32_t constraint) {
  for (const reading::MultiplierTerm& term : equation.multipliers) {
    if (term.constraint == constraint) return term.slope;
  }
  return Sum();
}

}  // namespace

TEST_CASE("R6: the plane exerts the force and, on the dual Euler basis, the moment of (9.84)") {
  const DisplayedModel r6("R6_rolling_disk");
  const reading::DisplayForm one = reading::derive_display_form(r6.s.mechanics, system::Approach::one);
  CHECK(shown(r6, one, "constraint force") == "F = lambda_1 E_1 + lambda_2 E_2 + lambda_3 E_3");
  CHECK(shown(r6, one, "constraint moment") ==
        "M = lambda_1 (R cos(phi) cos(theta) g^phi - R sin(phi) sin(theta) g^theta + R cos(phi) g^psi)"
        " + lambda_2 (R sin(phi) cos(theta) g^phi + R cos(phi) sin(theta) g^theta + R sin(phi) g^psi) - lambda_3 R "
        "cos(theta) g^theta");
}

// (9.88) without a fifth line's term that is missing in print: -lambda phi_dot^2 sin(theta) cos(theta).
TEST_CASE("R6: approach I gives the six equations (9.87), written out as the corrected (9.88)") {
  DisplayedModel r6("R6_rolling_disk");
  const reading::DisplayForm one = r6.form(system::Approach::one);
  const Sum n = r6("theta"), phi = r6("phi"), J = r6("J"), J3 = r6("J3"), R = r6("R"), m = r6("m");
  const Sum dphi = r6("phi_dot"), dn = r6("theta_dot"), ddphi = r6("phi_ddot"), ddpsi = r6("psi_ddot"),
            ddn = r6("theta_ddot");
  const Sum w3 = r6("psi_dot") + dphi * cos(n), dw3 = ddpsi + ddphi * cos(n) - dphi * dn * sin(n);
  CHECK(same(r6.motion(one, "x1"), m * r6("x1_ddot")));
  CHECK(same(r6.motion(one, "x2"), m * r6("x2_ddot")));
  CHECK(same(r6.motion(one, "x3"), m * r6("x3_ddot") + m * r6("g")));
  const Sum about_E3 = J * ddphi * square(sin(n)) + reading::Rational(2) * J * dphi * dn * sin(n) * cos(n) +
                       J3 * (dw3 * cos(n) - w3 * dn * sin(n));
  CHECK(same(r6.motion(one, "phi"), about_E3));
  CHECK(same(r6.motion(one, "theta"), J * ddn + J3 * w3 * dphi * sin(n) - J * square(dphi) * sin(n) * cos(n)));
  CHECK(same(r6.motion(one, "psi"), J3 * dw3));
  CHECK(same(slope(r6.equation(one, "phi"), 0), R * cos(n) * cos(phi)));
  CHECK(same(slope(r6.equation(one, "phi"), 1), R * cos(n) * sin(phi)));
  CHECK(slope(r6.equation(one, "phi"), 2).is_zero());
  CHECK(same(slope(r6.equation(one, "theta"), 0), Sum() - R * sin(n) * sin(phi)));
  CHECK(same(slope(r6.equation(one, "theta"), 1), R * sin(n) * cos(phi)));
  CHECK(same(slope(r6.equation(one, "theta"), 2), Sum() - R * cos(n)));
  CHECK(same(slope(r6.equation(one, "psi"), 0), R * cos(phi)));
  CHECK(same(slope(r6.equation(one, "psi"), 1), R * sin(phi)));
}

// With x3 = R sin(theta) imposed; the fourth line as docs/theory.md has it, which print garbles.
TEST_CASE(
    "R6: approach II has five equations: of the sliding disk the corrected (9.93), no force of the plane in them") {
  DisplayedModel r6("R6_sliding_disk");
  const reading::DisplayForm two = r6.form(system::Approach::two);
  REQUIRE(two.equations.size() == 5);
  for (const reading::Equation& equation : two.equations) CHECK(equation.multipliers.empty());
  const Sum n = r6("theta"), J = r6("J"), J3 = r6("J3"), R = r6("R"), m = r6("m");
  const Sum dphi = r6("phi_dot"), dn = r6("theta_dot"), dpsi = r6("psi_dot"), mR2 = m * square(R);
  CHECK(same(r6.equation(two, "theta").momentum, (J + mR2 * square(cos(n))) * dn));
  const Sum rest = J3 * dpsi * dphi * sin(n) + ((J3 - J) * square(dphi) + mR2 * square(dn)) * sin(n) * cos(n) +
                   m * r6("g") * R * cos(n);
  CHECK(same(Sum() - r6.equation(two, "theta").slope, rest));
  CHECK(same(r6.equation(two, "phi").momentum, J * square(sin(n)) * dphi + J3 * (dpsi + dphi * cos(n)) * cos(n)));
  CHECK(same(r6.equation(two, "psi").momentum, J3 * (dpsi + dphi * cos(n))));
  for (const char* cyclic : {"x1", "x2", "phi", "psi"}) CHECK(r6.equation(two, cyclic).slope.is_zero());
  CHECK(same(two.potential, m * r6("g") * R * sin(n)));
}

// With K = phi_dot sin^2(theta): dK/dtheta = (J3/J) w3 sin(theta), dw3/dtheta = m R^2 K/((J3 + m R^2) sin(theta)). Both
// follow from Euler's equations about the centre and hold whatever theta does in time: carried back to theta = pi/2 the
// pair is constant.
TEST_CASE("R6: the integrals of Appell, Chaplygin and Korteweg are constant along the run") {
  const FinishedRun run = run_model("R6_rolling_disk", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  const double m = run.parameter("m"), R = run.parameter("R"), J = m * R * R / 4, J3 = m * R * R / 2;
  using Pair = std::array<double, 2>;
  const auto slopes = [&](double theta, const Pair& y) {
    return Pair{J3 / J * y[1] * std::sin(theta), m * R * R * y[0] / ((J3 + m * R * R) * std::sin(theta))};
  };
  const auto carried = [&](double from, Pair y) {
    constexpr int steps = 400;  // of the classical Runge-Kutta method over at most half a turn: errors below 1e-11
    const double h = (std::acos(0.0) - from) / steps;
    for (int i = 0; i < steps; ++i) {
      const double theta = from + i * h;
      const auto moved = [&](const Pair& k, double by) { return Pair{y[0] + by * k[0], y[1] + by * k[1]}; };
      const Pair a = slopes(theta, y), b = slopes(theta + h / 2, moved(a, h / 2)),
                 c = slopes(theta + h / 2, moved(b, h / 2)), d = slopes(theta + h, moved(c, h));
      for (std::size_t k = 0; k < 2; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    return y;
  };
  Pair first{}, least{1e9, 1e9}, most{-1e9, -1e9};
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double theta = run.rows.at(i, "theta"), K = run.rows.at(i, "phi_dot") * std::pow(std::sin(theta), 2),
                 w3 = run.rows.at(i, "disk.omega3");
    const Pair integrals = carried(theta, {K, w3});
    if (i == 0) first = integrals;
    for (std::size_t k = 0; k < 2; ++k) CHECK(integrals[k] == doctest::Approx(first[k]).epsilon(1e-9).scale(1));
    least = {std::min(least[0], K), std::min(least[1], w3)};
    most = {std::max(most[0], K), std::max(most[1], w3)};
  }
  CHECK(most[0] - least[0] > 0.5);  // although neither of the two is constant by itself
  CHECK(most[1] - least[1] > 0.1);
}
