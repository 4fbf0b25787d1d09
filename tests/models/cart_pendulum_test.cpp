// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("cart_pendulum: p_x + c x is constant, since friction is the only force along the track") {
  const test::FinishedRun run = test::run_model("cart_pendulum", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
  });
  const double M = run.parameter("M"), m = run.parameter("m"), l = run.parameter("l"), c = run.parameter("c");
  const auto integral = [&](std::size_t i) {
    const test::Rows& r = run.rows;
    return (M + m) * r.at(i, "x_dot") + m * l * r.at(i, "theta_dot") * std::cos(r.at(i, "theta")) + c * r.at(i, "x");
  };
  for (std::size_t i = 0; i < run.rows.size(); ++i) CHECK(std::abs(integral(i)) < 1e-10);  // it starts at rest: 0
  CHECK(run.simulation.result.power_balance < 1e-9);
  CHECK(run.final("energy") < run.rows.at(0, "energy"));
}

TEST_CASE("cart_pendulum: a jump of a force restarts the integration, and its work is in the power balance") {
  const std::string path = test::build_folder() + "/cart_pushed.toml";
  std::string text = test::read_text(test::model_path("cart_pendulum"));
  text += "\n[scene.pushed]\nfrom = \"default\"\nt = [0, 4]\ninputs = { F = { t = [0, 1, 2], value = [0, 5, 0] } }\n";
  test::write_text(path, text);
  const auto run_at = [&](double rtol) {
    return test::run_model(path, [rtol](pipeline::SimulationRequest& request) {
      request.scene = "pushed";
      request.overrides.rtol = rtol;
      request.overrides.atol = rtol;
    });
  };
  const test::FinishedRun run = run_at(1e-10), tight = run_at(1e-13);
  CHECK(run.simulation.result.power_balance < 1e-8);
  CHECK(run.final("x") > 0.5);
  // Without restarts at the jumps the error would be far above the tolerance.
  CHECK(std::abs(run.final("x") - tight.final("x")) < 1e-8);
  CHECK(std::abs(run.final("theta") - tight.final("theta")) < 1e-8);
}
