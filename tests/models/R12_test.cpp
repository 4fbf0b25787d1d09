// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

// Balance of momentum and of moment of momentum about the pin, along the body's axes: F = m a + m g E3 with a = d
// (alpha e2 - W^2 e1), and dH/dt = M + r x (-m g E3) with H = W (J13 - m d h, J23, J33 + m d^2).
TEST_CASE("R12: the five reactions of the pin satisfy Euler's laws for an unbalanced and a balanced body") {
  for (const char* scene : {"default", "balanced"}) {
    INFO(scene);
    const test::FinishedRun run = test::run_model("R12_pinned_body", [&](pipeline::SimulationRequest& request) {
      request.scene = scene;
      request.overrides.rtol = request.overrides.atol = 1e-12;
    });
    const auto p = [&](const char* name) { return run.parameter(name); };
    const double m = p("m"), g = p("g"), d = p("d"), J13 = p("J13") - m * d * p("h"), J23 = p("J23"),
                 J33 = p("J3") + m * d * d;
    const double alpha = p("M0") / J33;
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      const double t = run.rows.t[i], W = 5 + alpha * t, a = 0.3 + 5 * t + alpha * t * t / 2;
      CHECK(run.rows.at(i, "a") == doctest::Approx(a).epsilon(1e-10));
      const double along = -m * d * W * W, across = m * d * alpha;
      const auto near = [](double x) { return doctest::Approx(x).epsilon(1e-9).scale(1); };
      CHECK(run.rows.at(i, "reaction.pin.1") == near(along * std::cos(a) - across * std::sin(a)));
      CHECK(run.rows.at(i, "reaction.pin.2") == near(along * std::sin(a) + across * std::cos(a)));
      CHECK(run.rows.at(i, "reaction.pin.3") == near(m * g));
      CHECK(run.rows.at(i, "reaction.roll") == near(J13 * alpha - J23 * W * W));
      CHECK(run.rows.at(i, "reaction.tilt") == near(J23 * alpha + J13 * W * W - m * g * d));
    }
  }
}
