// SPDX-License-Identifier: GPL-3.0-or-later
// A horizontal plane that moves with v(t) E3, eq. (1.35): z - h is the integral of v from the start of the run. Every
// run here checks both approaches against the independent oracle, which integrates v by quadrature.
#include <doctest/doctest.h>

#include <cmath>

#include "displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

void tight(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-12;
  request.overrides.atol = 1e-12;
}

// Motion by the spring in the plane, independent of the plane: x and y oscillate with sqrt(k/m).
void check_swing(const test::FinishedRun& run, std::size_t i) {
  const double w = std::sqrt(run.parameter("k") / run.parameter("m")), phase = w * (run.rows.t[i] - run.rows.t[0]);
  CHECK(run.rows.at(i, "x") == doctest::Approx(std::cos(phase)).epsilon(1e-10));
  CHECK(run.rows.at(i, "y") == doctest::Approx(1.5 / w * std::sin(phase)).epsilon(1e-10));
}

}  // namespace

TEST_CASE("P3: height and reaction have their closed forms, for any start time") {
  for (const char* scene : {"default", "later"}) {
    CAPTURE(scene);
    const test::FinishedRun run = test::run_model("P3_moving_plane", [&](pipeline::SimulationRequest& request) {
      tight(request);
      request.scene = scene;
    });
    CHECK(run.simulation.certificate.pass);
    const double m = run.parameter("m"), g = run.parameter("g"), h = run.parameter("h"), v0 = run.parameter("v0");
    const double a = run.parameter("a"), w = run.parameter("w"), t0 = run.rows.t[0];
    CHECK(run.parameter("t_start") == t0);
    CHECK(run.rows.size() > 100);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      const double t = run.rows.t[i];
      const double height = h + v0 * (t - t0) - a / w * (std::cos(w * t) - std::cos(w * t0));
      CHECK(run.rows.at(i, "z") == doctest::Approx(height).epsilon(1e-14));  // an expression of t, not integrated
      CHECK(run.rows.at(i, "reaction.plane") == doctest::Approx(m * (g + a * w * std::cos(w * t))).epsilon(1e-14));
      check_swing(run, i);
    }
    CHECK(run.simulation.result.power_balance < 1e-10);  // the plane does the work N v
  }
}

TEST_CASE("P3: in the display form the integral remains an integral, and its rate is v") {
  test::DisplayedModel read("P3_moving_plane");
  const reading::DisplayForm form = read.form(system::Approach::one);
  REQUIRE(form.reactions.size() == 1);
  REQUIRE(form.reactions[0].value);
  CHECK(test::same(*form.reactions[0].value, read("m") * read("v_dot") + read("m") * read("g")));
  REQUIRE(form.constraints.size() == 1);
  CHECK(test::same(form.constraints[0].value_rate, read("v")));
  CHECK(test::same(form.constraints[0].value_acceleration, read("v_dot")));
}

TEST_CASE("P3: an integral that is not elementary is a state with the value of the error function") {
  const test::FinishedRun run = test::run_model("P3_moving_plane_gust", tight);
  CHECK(run.simulation.certificate.pass);
  CHECK(run.simulation.program.states.size() == 1);
  const double m = run.parameter("m"), g = run.parameter("g"), v0 = run.parameter("v0"), tau = run.parameter("tau");
  const double t0 = run.rows.t[0];
  CHECK(run.error("integral_1") < 1e-11);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i], v = v0 * std::exp(-t * t / (tau * tau));
    const double height = v0 * tau * std::sqrt(std::acos(-1.0)) / 2 * (std::erf(t / tau) - std::erf(t0 / tau));
    CHECK(run.rows.at(i, "z") == doctest::Approx(height).epsilon(1e-11));  // a state, integrated at rtol 1e-12
    CHECK(run.rows.at(i, "reaction.plane") == doctest::Approx(m * (g - 2 * t / (tau * tau) * v)).epsilon(1e-13));
    check_swing(run, i);
  }
  CHECK(run.simulation.result.power_balance < 1e-10);
}

TEST_CASE("P3: the start time is set by the scene, and a zero factor of t is reported") {
  const auto problem = [](const char* parameter, long value) -> std::string {
    try {
      test::run_model("P3_moving_plane",
                      [&](pipeline::SimulationRequest& request) { request.overrides.values[parameter] = value; });
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return "";
  };
  CHECK(problem("t_start", 1).find("the start of the run") != std::string::npos);
  CHECK(problem("w", 0).find("the integral of this has no value") != std::string::npos);
  CHECK(problem("a", 0) == "");
}
