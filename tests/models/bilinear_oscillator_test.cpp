// SPDX-License-Identifier: GPL-3.0-or-later
// Kinks: the surface is located, the branch held within the steps.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using std::numbers::pi;

namespace {

// Ten periods at rtol 1e-13.
constexpr double impact_tolerance = 1e-10;

pipeline::SimulationRequest& with_tight_tolerances(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-13;
  request.overrides.atol = 1e-14;
  return request;
}

/// The same oscillator with other forces, written into the test's folder.
std::string variant(const std::string& name, const std::string& forces, const std::string& initial = "x = 0.1") {
  std::string text = test::read_text(test::model_path("bilinear_oscillator"));
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("-k1*max(0, x) - k2*min(0, x)", forces);
  replace("initial = { x = 0.1 }", "initial = { " + initial + " }");
  const std::string path = test::build_folder() + "/" + name + ".toml";
  test::write_text(path, text);
  return path;
}

}  // namespace

TEST_CASE("bilinear_oscillator: after ten periods it is where it started, and the kink was crossed twice in each") {
  for (const char* solver : {"dopri5", "tsit5", "dop853"}) {
    const test::FinishedRun run = test::run_model(
        "bilinear_oscillator",
        [solver](pipeline::SimulationRequest& request) { with_tight_tolerances(request).overrides.solver = solver; });
    const run::RunResult& result = run.simulation.result;
    CAPTURE(solver);
    CHECK(result.outcome == eom::Outcome::done);
    const double rate = 0.1 * std::sqrt(run.parameter("k1") / run.parameter("m"));
    CHECK(std::abs(run.final("x") - 0.1) < impact_tolerance);
    CHECK(std::abs(run.final("x_dot")) < impact_tolerance * 10 * rate / 0.1);
    REQUIRE(result.kinks.size() == 1);  // max and min have the same surface
    CHECK(result.kinks[0].count == 20);
    MESSAGE(solver, ": ", result.statistics.steps, " steps, ", result.statistics.rejected, " rejected, ",
            result.statistics.rhs_evaluations, " evaluations, error ", std::abs(run.final("x") - 0.1));
  }
}

TEST_CASE(
    "bilinear_oscillator: with the branch held, no step is refused for the kink; abs and if do as max and min do") {
  const test::FinishedRun smooth =
      test::run_model(variant("linear", "-k1*x"), [](auto& request) { with_tight_tolerances(request); });
  const test::FinishedRun two =
      test::run_model("bilinear_oscillator", [](auto& request) { with_tight_tolerances(request); });
  for (const auto& [name, forces] :
       {std::pair{"with_abs", "-(k1 + k2)/2*x - (k1 - k2)/2*abs(x)"}, std::pair{"with_if", "if(x > 0, -k1*x, -k2*x)"},
        std::pair{"with_sign", "-x*((k1 + k2)/2 + (k1 - k2)/2*sign(x))"}}) {
    const auto& shown = name;
    CAPTURE(shown);
    const test::FinishedRun run =
        test::run_model(variant(name, forces), [](auto& request) { with_tight_tolerances(request); });
    REQUIRE(run.simulation.result.kinks.size() == 1);
    CHECK(run.simulation.result.kinks[0].count == 20);
    CHECK(std::abs(run.final("x") - two.final("x")) < impact_tolerance);
  }
  CHECK(smooth.simulation.result.kinks.empty());
  // 20 crossings: a step or two each, where control of the error alone would refuse several at each of them.
  CHECK(two.simulation.result.statistics.rejected < 40);
}

TEST_CASE("bilinear_oscillator: a start on the kink itself is no crossing") {
  const test::FinishedRun run = test::run_model(variant("from_kink", "-k1*max(0, x) - k2*min(0, x)", "x_dot = 0.7"),
                                                [](auto& request) { with_tight_tolerances(request); });
  CHECK(std::abs(run.final("x")) < impact_tolerance);
  CHECK(std::abs(run.final("x_dot") - 0.7) < 10 * impact_tolerance);
  // Nineteen inside, and the one at the very end that rounding may put before or behind it.
  CHECK(run.simulation.result.kinks.at(0).count >= 19);
  CHECK(run.simulation.result.kinks.at(0).count <= 20);
}

TEST_CASE("bilinear_oscillator: a branch without a value beyond its surface is left in time") {
  // A ball on an elastic ground after Hertz: k x^(3/2) while it is in contact. Held at x < 0 it has no value
  // above the ground, where the last trial step of each contact goes.
  const std::string path = variant("hertz", "-m*9.81[m/s^2] + 1e5[N/m]*max(0, -x)*sqrt(max(0, -x)/1[m])", "x = 0.2");
  const test::FinishedRun run = test::run_model(path, [](auto& request) {
    with_tight_tolerances(request);
    request.overrides.t_end = 2;
    request.overrides.every = 0.001;
  });
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.result.kinks.at(0).count >= 6);
  CHECK(run.simulation.result.power_balance < 1e-10);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double x = run.rows.at(i, "x"), v = run.rows.at(i, "x_dot");
    const double spring = x < 0 ? 1e5 * 0.4 * std::pow(-x, 2.5) : 0;
    // Rows are read off the dense output.
    CHECK(std::abs(0.5 * 2 * v * v + 2 * 9.81 * x + spring - 2 * 9.81 * 0.2) < 1e-8);
  }
}

TEST_CASE("bilinear_oscillator: discontinuous friction slips by its closed form, and sticks") {
  // x'' = -(k/m) x - (F/m) sign(x_dot) with F/k = 0.03: each half period swings about +-0.03, from 0.1 to -0.04 and on
  // to -0.02, where the spring is weaker than the friction.
  const std::string path = variant("dry", "-k1*x - 0.03[m]*k1*sign(x_dot)");
  const test::FinishedRun run = test::run_model(path, [](auto& request) { with_tight_tolerances(request); });
  const run::RunResult& result = run.simulation.result;
  CHECK(result.outcome == eom::Outcome::done);
  const auto slides = [](const run::RunEvent& event) { return event.kind == "slide"; };
  const auto stick = std::find_if(result.events.begin(), result.events.end(), slides);
  REQUIRE(stick != result.events.end());
  CHECK(stick->name == "sign");
  CHECK(std::abs(stick->t - 2 * pi * std::sqrt(2.0 / 50)) < impact_tolerance);
  CHECK(std::abs(run.final("x") + 0.02) < impact_tolerance);
  CHECK(run.final("x_dot") == 0);
}
