// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "reading/contravariant.hpp"
#include "reading/ginac_bridge.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

using Six = std::array<Sum, 6>;  // along e1 .. e6: E1..E3 of P1, then of P2

Six covariant(DisplayedModel& s4, const std::string& q) {
  reading::GinacBridge bridge(s4.s.mechanics);
  const reading::Symbol by = s4(q).terms().begin()->first[0].atom->symbol;
  Six a;
  for (std::size_t c = 0; c < 6; ++c)
    a[c] = bridge.derivative(bridge.sum((*s4.s.mechanics.place_position[1 + c / 3])[c % 3]), by);
  return a;
}

}  // namespace

TEST_CASE("S4: the six covariant basis vectors are (3.71), and (3.72) is dual to them") {
  DisplayedModel s4("S4_two_particles");
  const Sum r = s4("r1"), R = s4("R2"), o, one(1);
  const Sum c1 = cos(s4("theta1")), s1 = sin(s4("theta1")), c2 = cos(s4("theta2")), s2 = sin(s4("theta2"));
  const Sum cp = cos(s4("phi2")), sp = sin(s4("phi2"));
  const std::array<std::string, 6> q{"r1", "theta1", "z1", "R2", "phi2", "theta2"};
  const std::array<Six, 6> printed{{{c1, s1, o, c1, s1, o},
                                    {-r * s1, r * c1, o, -r * s1, r * c1, o},
                                    {o, o, one, o, o, one},
                                    {o, o, o, sp * c2, sp * s2, cp},
                                    {o, o, o, R * cp * c2, R * cp * s2, -R * sp},
                                    {o, o, o, -R * sp * s2, R * sp * c2, o}}};
  const Sum x5 = over(cp * c2, R), y5 = over(cp * s2, R), z5 = over(sp, R), x6 = over(s2, R * sp),
            y6 = over(c2, R * sp);
  const std::array<Six, 6> dual{{{c1, s1, o, o, o, o},
                                 {over(-s1, r), over(c1, r), o, o, o, o},
                                 {o, o, one, o, o, o},
                                 {-sp * c2, -sp * s2, -cp, sp * c2, sp * s2, cp},
                                 {-x5, -y5, z5, x5, y5, -z5},
                                 {x6, -y6, o, -x6, y6, o}}};
  for (std::size_t i = 0; i < 6; ++i) {
    CAPTURE(q[i]);
    const Six a = covariant(s4, q[i]);
    for (std::size_t c = 0; c < 6; ++c) CHECK(same(a[c], printed[i][c]));
    for (std::size_t k = 0; k < 6; ++k) {
      Sum product;
      for (std::size_t c = 0; c < 6; ++c) product += a[c] * dual[k][c];
      CHECK(same(product, Sum(i == k ? 1 : 0)));
    }
  }
}

// In E^6, which is flat, each particle has the symbols of its own coordinates, (2.185).
TEST_CASE(
    "S4: the contravariant equations are those of two particles with the spring's force over m1 and the reduced mass") {
  DisplayedModel s4("S4_two_particles");
  const Sum r = s4("r1"), R = s4("R2"), sp = sin(s4("phi2")), cp = cos(s4("phi2"));
  const Sum dth1 = s4("theta1_dot"), dR = s4("R2_dot"), dphi = s4("phi2_dot"), dth2 = s4("theta2_dot");
  const Sum c = cos(s4("theta2") - s4("theta1")), s = sin(s4("theta2") - s4("theta1")), m1 = s4("m1"), m2 = s4("m2");
  const Sum pull = s4("k") * (R - s4("L")), two(2), o;
  const reading::ContravariantForm form = reading::contravariant_form(s4.s.mechanics);
  REQUIRE(form.skip_reason.empty());
  const std::array<std::array<Sum, 2>, 6> expected{
      {{-r * square(dth1), over(pull * sp * c, m1)},
       {over(two * s4("r1_dot") * dth1, r), over(pull * sp * s, m1 * r)},
       {o, over(pull * cp, m1)},
       {-R * square(dphi) - R * square(sp * dth2), -over(pull * (m1 + m2), m1 * m2)},
       {over(two * dR * dphi, R) - sp * cp * square(dth2), o},
       {over(two * dR * dth2, R) + over(two * cp * dphi * dth2, sp), o}}};
  REQUIRE(form.equations.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(same(form.equations[i].curvature, expected[i][0]));
    CHECK(same(form.equations[i].force, expected[i][1]));
  }
}

TEST_CASE("S4: the kinetic energy is (3.73), and there are six equations") {
  DisplayedModel s4("S4_two_particles");
  const reading::DisplayForm form = s4.form(system::Approach::two);
  CHECK(form.equations.size() == 6);
  const Sum m1 = s4("m1"), m2 = s4("m2"), r = s4("r1"), R = s4("R2"), cp = cos(s4("phi2")), sp = sin(s4("phi2"));
  const Sum c = cos(s4("theta2") - s4("theta1")), s = sin(s4("theta2") - s4("theta1"));
  const Sum dr = s4("r1_dot"), dth1 = s4("theta1_dot"), dz = s4("z1_dot"), dR = s4("R2_dot"), dphi = s4("phi2_dot"),
            dth2 = s4("theta2_dot");
  const Sum kinetic = half(m1 + m2) * (square(dr) + square(r * dth1) + square(dz)) +
                      half(m2) * (square(dR) + square(R * dphi) + square(R * sp * dth2)) +
                      m2 * cp * (dR * dz + dphi * dr * R * c + dphi * dth1 * r * R * s) -
                      m2 * sp * (R * dphi * dz - r * R * dth1 * dth2 * c - dr * dR * c) -
                      m2 * sp * (dr * dth2 * R * s - r * dR * dth1 * s);
  CHECK(same(form.kinetic, kinetic));
  CHECK(same(form.potential, half(s4("k")) * square(R - s4("L"))));
}

TEST_CASE("S4: momentum, angular momentum and energy are conserved") {
  const FinishedRun run = run_model("S4_two_particles", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  constexpr double tolerance = 1e-9;  // of values around 1 over ten seconds, some five periods of the spring
  CHECK(run.drift("energy") < tolerance);
  for (const char* name : {"G1", "G2", "G3", "H1", "H2", "H3"}) {
    CAPTURE(name);
    double worst = 0;
    for (std::size_t i = 0; i < run.rows.size(); ++i)
      worst = std::max(worst, std::abs(run.rows.at(i, name) - run.rows.at(0, name)));
    CHECK(std::abs(run.rows.at(0, name)) > 1e-3);
    CHECK(worst < tolerance);
  }
  double least = 10, most = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    least = std::min(least, run.rows.at(i, "distance"));
    most = std::max(most, run.rows.at(i, "distance"));
  }
  CHECK(most > 1.2 * least);  // the spring is active
}
