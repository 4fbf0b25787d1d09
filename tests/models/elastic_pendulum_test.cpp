// SPDX-License-Identifier: GPL-3.0-or-later
// A spring nearly as stiff as a rod: what the solvers for stiff systems are for.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "support/simulation.hpp"

using namespace eomgen;

namespace {

test::FinishedRun motion(const std::string& scene, const std::string& solver, double rtol, double step = 0) {
  return test::run_model("elastic_pendulum", [&](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.solver = solver;
    request.overrides.rtol = rtol;
    request.overrides.atol = rtol;
    if (step > 0) request.overrides.step = step;
  });
}

double difference(const test::FinishedRun& a, const test::FinishedRun& b, bool with_r_dot = true) {
  double largest = with_r_dot ? std::abs(a.final("r_dot") - b.final("r_dot")) : 0;
  for (const char* name : {"r", "theta", "theta_dot"})
    largest = std::max(largest, std::abs(a.final(name) - b.final(name)));
  return largest;
}

}  // namespace

TEST_CASE(
    "elastic_pendulum: k = 1e10 on the smooth solution: fewer than 2000 steps to 1e-8, where dop853 needs more than "
    "20000") {
  // dop853 follows the oscillation of 1e5 rad/s whether there is any or not; what its tolerance lets into it shows in
  // r_dot
  const test::FinishedRun resolved = motion("stiff", "dop853", 1e-9);
  CHECK(resolved.simulation.result.statistics.steps > 20'000);
  for (const char* solver : {"radau5", "rodas"}) {
    CAPTURE(std::string(solver));
    const test::FinishedRun stiff = motion("stiff", solver, 1e-10);
    const run::RunResult& result = stiff.simulation.result;
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(result.solver == solver);
    CHECK(run::to_text(result.reason) == "as asked for, df/dx from the equations");
    CHECK(result.statistics.steps < 2000);
    CHECK(result.statistics.difference_evaluations == 0);
    CHECK(difference(stiff, resolved, false) < 1e-8);
    CHECK(std::abs(stiff.final("r_dot")) < 1e-8);  // the smooth solution's is of the order m g/(k s)
    CHECK(stiff.error("max") < 1e-8);
    MESSAGE(std::string(solver), ": ", result.statistics.steps, " steps, ", result.statistics.rhs_evaluations,
            " evaluations, ", difference(stiff, resolved, false), " from dop853 with ",
            resolved.simulation.result.statistics.steps, " steps");
  }
}

TEST_CASE("elastic_pendulum: the scene 'stiff' names its solver") {
  const test::FinishedRun stiff =
      test::run_model("elastic_pendulum", [](pipeline::SimulationRequest& request) { request.scene = "stiff"; });
  CHECK(stiff.simulation.result.solver == "radau5");
  CHECK(stiff.simulation.result.statistics.steps < 2000);
}

TEST_CASE("elastic_pendulum: where the oscillation is part of the motion, all solvers resolve it alike") {
  for (const char* scene : {"default", "stretched"}) {
    CAPTURE(std::string(scene));
    const test::FinishedRun reference = motion(scene, "dop853", 1e-13);
    for (const char* solver : {"radau5", "rodas"}) {
      CAPTURE(std::string(solver));
      const test::FinishedRun other = motion(scene, solver, 1e-10);
      CHECK(difference(other, reference) < 1e-6);  // 2 s are 32 periods of the spring
      CHECK(difference(other, reference) < 10 * other.error("max"));
      CHECK(other.drift("energy") < 1e-6);
    }
  }
}

TEST_CASE("elastic_pendulum: midpoint keeps the energy within bounds that do not grow; its error is of order 2") {
  const test::FinishedRun reference = motion("stretched", "dop853", 1e-13);
  const test::FinishedRun coarse = motion("stretched", "midpoint", 1e-9, 1e-3),
                          fine = motion("stretched", "midpoint", 1e-9, 2.5e-4);
  const double order = std::log2(difference(coarse, reference) / difference(fine, reference)) / 2;
  CHECK(std::abs(order - 2) < 0.3);
  const test::FinishedRun longer = test::run_model("elastic_pendulum", [](pipeline::SimulationRequest& request) {
    request.scene = "stretched";
    request.overrides.solver = "midpoint";
    request.overrides.step = 1e-3;
    request.overrides.t_end = 40;
    request.estimate = false;
  });
  CHECK(longer.drift("energy") < 3 * coarse.drift("energy"));
}
