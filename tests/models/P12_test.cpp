// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "print/render.hpp"
#include "support/folders.hpp"
#include "support/particles.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("P12: of the set (1.79) the first constraint is integrable, the others are not") {
  const model::Model model = model::read_model(test::model_path("P12_pfaffian_set"));
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  REQUIRE(m.classification.size() == 3);
  CHECK(m.classification[0].integrable == mechanics::Integrability::yes);
  CHECK(m.classification[1].integrable == mechanics::Integrability::no);
  CHECK(m.classification[2].integrable == mechanics::Integrability::no);
  REQUIRE(m.integrals.size() == 1);
  CHECK(m.integrals[0].label == "first");
  CHECK(print::render_expression(m, "", "", m.integrals[0].psi).text == "1/2 (x1^2 + y1^2 + 2 h0 sin(w t)/w)");
}

TEST_CASE("P12: the integral keeps its initial value, and all three constraints hold") {
  const test::FinishedRun run = test::run_model("P12_pfaffian_set", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-6;  // a tolerance at which the distance would drift
    request.overrides.atol = 1e-6;
  });
  const double h0 = run.parameter("h0"), w = run.parameter("w");
  const auto integral = [&](std::size_t i) {
    const double x = run.rows.at(i, "x1"), y = run.rows.at(i, "y1");
    return (x * x + y * y) / 2 + h0 / w * std::sin(w * run.rows.t[i]);
  };
  const std::size_t last = run.rows.size() - 1;  // end of a step; earlier rows are between steps
  CHECK(integral(last) == doctest::Approx(integral(0)).epsilon(1e-13));
  CHECK(run.drift("integral.first") < 1e-13);
  CHECK(run.simulation.result.projection_position > 1e-10);  // the projection was necessary
  CHECK(run.simulation.result.constraint_drift < 1e-14);
  const auto y = [&](const char* name) { return run.rows.at(last, name); };
  CHECK(std::abs(y("y2_dot") + y("z2") * y("x2_dot")) < 1e-14);
  CHECK(std::abs(y("x3") * y("x3_dot") + y("z3") * y("y3") * (y("y3_dot") + y("z3_dot"))) < 1e-14);
}

TEST_CASE("P12: a run on the integral ends where the same motion with a holonomic constraint ends") {
  // phi_dot = 0 on the moving sphere, (2.114) with f2 = 1: a circle of radius d sin(phi0); as holonomic "phi - phi0".
  const auto circle = [](const std::string& second) {
    const std::string text =
        R"toml(format = 1
[parameters]
m = 1
g = 9.81
D = 0.3
[functions]
d = "1 + sin(2*t)/10"
)toml" + test::particle_in_space +
        R"toml([[force]]
on = "P"
force = "D*R*P.e_theta"
[[constraint]]
name = "sphere"
holonomic = "R - d"
[[constraint]]
name = "circle"
)toml" + second +
        "\n[scene.default]\nt = [0, 2]\ninitial = { phi = 1, theta_dot = 2 }\noutputs = [\"reaction.circle\"]\n";
    const std::string path = test::build_folder() + "/circle.toml";
    test::write_text(path, text);
    return test::run_model(
        path, [](pipeline::SimulationRequest& request) { request.overrides.rtol = request.overrides.atol = 1e-12; });
  };
  const test::FinishedRun bound = circle("velocity = \"phi_dot\""), fixed = circle("holonomic = \"phi - 1\"");
  CHECK(bound.drift("integral.circle") == 0);
  for (const char* name : {"theta", "theta_dot", "phi", "reaction.sphere", "reaction.circle"}) {
    INFO(name);
    CHECK(bound.final(name) == doctest::Approx(fixed.final(name)).epsilon(1e-10));
  }
}
