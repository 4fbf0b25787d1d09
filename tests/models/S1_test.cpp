// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;

TEST_CASE("S1: the motion of the two masses is the sum of their modes") {
  const test::FinishedRun run = test::run_model("S1_two_masses", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  const double k1 = run.parameter("k1"), k2 = run.parameter("k2");
  const Eigen::Matrix2d M = Eigen::Vector2d(run.parameter("m1"), run.parameter("m2")).asDiagonal();
  const Eigen::Matrix2d K = (Eigen::Matrix2d() << k1 + k2, -k2, -k2, k2).finished();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> modes(K, M);
  const Eigen::Vector2d start(0.1, 0), amplitudes = modes.eigenvectors().transpose() * M * start;
  double worst = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const Eigen::Vector2d cosines = (modes.eigenvalues().cwiseSqrt() * run.rows.t[i]).array().cos();
    const Eigen::Vector2d x = modes.eigenvectors() * cosines.cwiseProduct(amplitudes);
    worst = std::max({worst, std::abs(run.rows.at(i, "x1") - x(0)), std::abs(run.rows.at(i, "x2") - x(1))});
  }
  CHECK(worst < 1e-11);  // amplitudes of 0.1 over some 13 periods of the faster mode at rtol 1e-12
  CHECK(run.drift("energy") < 1e-11);
}

TEST_CASE("S1: the emitted right-hand side is linear: no sine, no root") {
  const test::FinishedRun run = test::run_model("S1_two_masses");
  const program::Operations& operations = run.simulation.program.functions.front().operations;
  CHECK(operations.trig == 0);
  CHECK(operations.sqrt == 0);
}
