// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

// One turn of the drum is n turns of the motor. Seen from the motor the inertia is J = J1 + J2/n1^2 + (J3 + m r^2)/n^2
// with n1 = r2/r1 and n = n1 R3/R2, and the load m g r/n, so that J w' = M0 (1 - w/w0) - m g r/n.
TEST_CASE("geared_hoist: the speed is that of a motor under load; the reactions satisfy the laws of Euler and Newton") {
  const test::FinishedRun run = test::run_model("geared_hoist", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  });
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double n1 = p("r2") / p("r1"), n2 = p("R3") / p("R2"), n = n1 * n2, r = p("r"), m = p("m");
  const double J = p("J1") + p("J2") / (n1 * n1) + (p("J3") + m * r * r) / (n * n);
  const double load = m * p("g") * r / n, tau = J * p("w0") / p("M0"), w = p("w0") * (1 - load / p("M0"));
  REQUIRE(run.rows.size() > 100);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const auto at = [&](const char* name) { return run.rows.at(i, name); };
    // Turns of some 100 rad and moments of some 1000 N m; rows are read off the dense output.
    const auto near = [](double x) { return doctest::Approx(x).epsilon(1e-9).scale(10); };
    const double t = run.rows.t[i], fall = std::exp(-t / tau), speed = w * (1 - fall);
    const double turned = w * (t - tau * (1 - fall)), gain = w / tau * fall;
    CHECK(at("phi") == near(turned));
    CHECK(at("phi_dot") == near(speed));
    CHECK(at("psi") == near(-turned / n1));
    CHECK(at("chi_dot") == near(-speed / n));
    CHECK(at("y") == near(-p("h") + r * turned / n));
    CHECK(at("y_ddot") == near(r * gain / n));
    // Of the motor; of the shaft, on which the gears do -ratio times that; of the load.
    const double gears = p("J1") * gain - p("M0") * (1 - speed / p("w0"));
    CHECK(at("reaction.gears") == near(gears));
    CHECK(at("reaction.belt") == near(-p("J2") * gain / n1 - n1 * gears));
    CHECK(at("reaction.rope") == near(m * (p("g") + r * gain / n)));
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
  CHECK(run.simulation.derived->mechanics.degrees_of_freedom() == 1);
  CHECK(run.simulation.certificate.pass);
}
