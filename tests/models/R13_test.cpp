// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("R13: the constraint and the equations are (9.102), and it is not integrable") {
  DisplayedModel r13("R13_sleigh");
  const mechanics::Mechanics& m = r13.s.mechanics;
  REQUIRE(m.constraints.size() == 1);
  CHECK(m.classification[0].integrable == mechanics::Integrability::no);
  const Sum phi = r13("phi"), dphi = r13("phi_dot"), mu = r13.s.symbol.multiplier(0);
  const reading::DisplayForm form = r13.form(system::Approach::one);
  const auto multiplier = [&](const char* q) { return r13.equation(form, q).multipliers.at(0).slope; };
  CHECK(same(r13.motion(form, "x1"), r13("m") * r13("x1_ddot")));
  CHECK(same(r13.motion(form, "phi"), r13("J") * r13("phi_ddot")));
  CHECK(same(multiplier("x1"), -sin(phi)));  // m x1_ddot = -mu sin(phi)
  CHECK(same(multiplier("x2"), cos(phi)));
  CHECK(same(multiplier("phi"), -r13("L1")));
  CHECK(same(form.constraints.at(0).rate, r13("x2_dot") * cos(phi) - r13("x1_dot") * sin(phi) - r13("L1") * dphi));
}

// With v the speed of the centre along e1: vdot = L1 w^2, (J + m L1^2) wdot = -m L1 v w, so that v = c tanh(L1 c t/k^2
// + ..), k^2 = L1^2 + J/m, c^2 = v^2 + k^2 w^2.
TEST_CASE("R13: it turns around and approaches straight motion as tanh, and conserves energy") {
  const FinishedRun run = run_model("R13_sleigh", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  });
  const double L1 = run.parameter("L1"), k2 = L1 * L1 + run.parameter("J") / run.parameter("m");
  const double v0 = -3, w0 = 1.5, c = std::sqrt(v0 * v0 + k2 * w0 * w0), shift = std::atanh(v0 / c);
  double greatest = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double s = L1 * c / k2 * run.rows.t[i] + shift;
    CHECK(std::abs(run.rows.at(i, "forward") - c * std::tanh(s)) < 1e-9);
    CHECK(std::abs(run.rows.at(i, "phi_dot") - c / std::sqrt(k2) / std::cosh(s)) < 1e-9);
    greatest = std::max(greatest, run.rows.at(i, "phi_dot"));
  }
  CHECK(greatest > 2);
  CHECK(run.final("forward") == doctest::Approx(c).epsilon(1e-6));
  CHECK(run.drift("energy") < 1e-11);
  const FinishedRun straight =
      run_model("R13_sleigh", [](pipeline::SimulationRequest& request) { request.scene = "straight"; });
  CHECK(straight.final("x1") == doctest::Approx(50).epsilon(1e-12));
  CHECK(std::abs(straight.final("phi")) < 1e-14);
}
