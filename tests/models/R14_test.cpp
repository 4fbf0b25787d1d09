// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("R14: T is (9.104), the motion (9.106), the constraint force and moment (9.107)") {
  DisplayedModel r14("R14_sliding_cylinder");
  const reading::DisplayForm one = r14.form(system::Approach::one);
  const Sum n = r14("theta"), psi = r14("psi"), dphi = r14("phi_dot"), dn = r14("theta_dot"), dpsi = r14("psi_dot");
  const Sum v2 = square(r14("x1_dot")) + square(r14("x2_dot")) + square(r14("x3_dot"));
  const Sum T = half(r14("m") * v2) +
                half(r14("Jt") * (square(dn * sin(psi) - dphi * sin(n) * cos(psi)) + square(dpsi + dphi * cos(n)))) +
                half(r14("Ja") * square(dn * cos(psi) + dphi * sin(n) * sin(psi)));
  CHECK(same(one.kinetic, T));
  CHECK(same(r14.motion(one, "theta"), r14("Ja") * r14("theta_ddot")));
  CHECK(same(r14.motion(one, "phi"), r14("Jt") * r14("phi_ddot")));
  REQUIRE(one.reactions.size() == 2);
  CHECK(same(*one.reactions[0].value, r14("m") * r14("g")));
  CHECK(same(*one.reactions[1].value,
             r14("Jt") * r14("phi_ddot") * cos(n) - r14("Ja") * dphi * dn * sin(n)));  // and phi_ddot = 0
}

TEST_CASE("R14: theta = 0, pi is singular in approach I and regular in approach II, which passes through it") {
  DisplayedModel r14("R14_sliding_cylinder");
  const std::vector<reading::SingularSet> sets = reading::singular_sets(r14.s.mechanics);
  REQUIRE(sets.size() == 1);
  CHECK(sets[0].approach == "I");
  CHECK(same(square(sets[0].factor), square(sin(r14("theta")))));
  const FinishedRun run = run_model("R14_sliding_cylinder");
  CHECK(run.final("theta") == doctest::Approx(5).epsilon(1e-12));
  CHECK(run.final("phi") == doctest::Approx(3.5).epsilon(1e-12));
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double expected = -0.01 * 0.7 * std::sin(run.rows.t[i]);
    CHECK(run.rows.at(i, "reaction.level") == doctest::Approx(expected).epsilon(1e-9).scale(1e-3));
    CHECK(run.rows.at(i, "reaction.plane") == doctest::Approx(2 * 9.81).epsilon(1e-12));
  }
}
