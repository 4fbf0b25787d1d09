// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "print/render.hpp"
#include "reading/reading.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

test::FinishedRun skate() {
  return test::run_model("knife_edge", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
}

}  // namespace

// theta = theta0 + w t; along the blade v = v0 + k (sin(theta) - sin(theta0)) with k = g sin(beta)/w.
TEST_CASE("knife_edge: the skate follows the closed form") {
  const test::FinishedRun run = skate();
  const double w = 1.5, theta0 = 0.2, v0 = 0.5 / std::cos(theta0),
               k = run.parameter("g") * std::sin(run.parameter("beta")) / w;
  const double c = v0 - k * std::sin(theta0);
  const auto x = [&](double th) { return (c * std::sin(th) + k / 2 * std::sin(th) * std::sin(th)) / w; };
  const auto y = [&](double th) { return (-c * std::cos(th) + k / 2 * (th - std::sin(th) * std::cos(th))) / w; };
  double worst = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double theta = theta0 + w * run.rows.t[i];
    worst = std::max({worst, std::abs(run.rows.at(i, "theta") - theta),
                      std::abs(run.rows.at(i, "x") - x(theta) + x(theta0)),
                      std::abs(run.rows.at(i, "y") - y(theta) + y(theta0))});
  }
  CHECK(worst < 1e-10);  // some 10 m over 2.4 turns at rtol 1e-12
  CHECK(run.drift("energy") < 1e-11);
  CHECK(run.simulation.result.constraint_drift < 1e-14);
}

// The force on the skate is lambda f with f = (sin(theta), -cos(theta)). Across the blade, along -f, the acceleration
// is v w to the left, so that lambda f . n = m v w - (gravity along n) with n = -f.
TEST_CASE("knife_edge: lambda has the sign of the normality prescription") {
  const test::FinishedRun run = skate();
  const double m = run.parameter("m"), slope = run.parameter("g") * std::sin(run.parameter("beta"));
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double theta = run.rows.at(i, "theta");
    const double v = run.rows.at(i, "x_dot") * std::cos(theta) + run.rows.at(i, "y_dot") * std::sin(theta);
    const double to_the_left = m * v * run.rows.at(i, "theta_dot") + m * slope * std::sin(theta);
    CHECK(-run.rows.at(i, "reaction.edge") == doctest::Approx(to_the_left).epsilon(1e-11));
  }
}

TEST_CASE("knife_edge: the display form has the constraint with its multiplier and time derivative") {
  const model::Model model = model::read_model(test::model_path("knife_edge"));
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  const reading::DisplayForm form = reading::derive_display_form(m, system::Approach::two);
  std::vector<std::string> text;
  for (const print::PrintedFormula& item : print::render(m, form, {"constraints", "equations"}))
    text.push_back(item.role + ": " + item.text);
  const auto shown = [&](const std::string& line) { return std::find(text.begin(), text.end(), line) != text.end(); };
  CHECK(shown("binds velocities, not integrable: x_dot sin(theta) - y_dot cos(theta) = 0"));
  CHECK(
      shown("its time derivative: sin(theta) x_ddot - cos(theta) y_ddot + cos(theta) x_dot theta_dot + sin(theta) "
            "y_dot theta_dot = 0"));
  CHECK(shown("motion: d/dt(m x_dot) - m g sin(beta) = lambda sin(theta)"));
  CHECK(shown("motion: d/dt(m y_dot) = -lambda cos(theta)"));
}
