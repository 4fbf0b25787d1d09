// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("P9: the normal force is (2.171), h is conserved, and with it the motion is (2.172), its energy (2.173)") {
  DisplayedModel p9("P9_paraboloid");
  const Sum m = p9("m"), g = p9("g"), c = p9("c"), u = p9("u"), du = p9("u_dot"), ddu = p9("u_ddot"),
            dth = p9("theta_dot");
  const Sum h = m * square(c * u) * dth;
  for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
    const reading::DisplayForm form = p9.form(approach);
    CHECK(same(p9.equation(form, "theta").momentum, h));
    CHECK(p9.equation(form, "theta").slope.is_zero());
    CHECK(p9.equation(form, "theta").force.is_zero());
    const Sum single =
        m * (square(u) + square(c)) * ddu + m * u * square(du) - over(square(h), m * u * u * u * square(c)) + m * g * u;
    CHECK(same(p9.motion(form, "u"), single));
  }
  const reading::DisplayForm one = p9.form(system::Approach::one), two = p9.form(system::Approach::two);
  REQUIRE(one.reactions.size() == 1);
  CHECK(same(*one.reactions[0].value, -(m * c * square(du) + m * square(u) * c * square(dth) + m * g * c)));
  const Sum energy = half(m) * (square(u) + square(c)) * square(du) + half(over(square(h), m * square(u * c))) +
                     half(m * g) * (square(u) - square(c));
  CHECK(same(two.kinetic + two.potential, energy));
}

TEST_CASE("P9: energy and h are conserved over 100 s, and u stays between the roots of (2.173)") {
  const FinishedRun run =
      run_model("P9_paraboloid", [](pipeline::SimulationRequest& request) { request.scene = "long"; });
  CHECK(run.drift("energy") < 1e-10);
  CHECK(run.drift("momentum.theta") < 1e-10);
  // u_dot = 0 in (2.173), multiplied with 2 u^2/m: g u^4 - (2 E/m + g c^2) u^2 + (h/(m c))^2 = 0
  const double m = run.parameter("m"), g = run.parameter("g"), c = run.parameter("c");
  const double h = m * c * c * 2, E = m / 2 * ((1 + c * c) * 0.4 * 0.4 + c * c * 4) + m * g / 2 * (1 - c * c);
  const double b = 2 * E / m + g * c * c, root = std::sqrt(b * b - 4 * g * h * h / (m * m * c * c));
  const double inner = std::sqrt((b - root) / (2 * g)), outer = std::sqrt((b + root) / (2 * g));
  double least = outer, most = inner;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    least = std::min(least, run.rows.at(i, "u"));
    most = std::max(most, run.rows.at(i, "u"));
  }
  CHECK(least > inner - 1e-10);
  CHECK(most < outer + 1e-10);
  CHECK(least < inner + 0.02);  // rows are 0.2 s apart: they come near the turning points
  CHECK(most > outer - 0.02);
}

TEST_CASE("P9: circular motions at any height have the same rate") {
  const FinishedRun run =
      run_model("P9_paraboloid", [](pipeline::SimulationRequest& request) { request.scene = "circle"; });
  const double rate = std::sqrt(run.parameter("g")) / run.parameter("c");
  constexpr double tolerance = 1e-7;  // of rtol 1e-9 over some 45 radians
  CHECK(run.final("u") == doctest::Approx(1).epsilon(tolerance));
  CHECK(run.final("theta") == doctest::Approx(10 * rate).epsilon(tolerance));
}
