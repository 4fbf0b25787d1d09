// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/simulation.hpp"

using namespace eomgen;
using Eigen::Vector3d;

namespace {

test::FinishedRun flight(const std::string& scene) {
  return test::run_model("R17_follower_force", [&](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
}

}  // namespace

TEST_CASE("R17: for a sphere w is constant, e3 rotates about it, and x is the double integral of F/m e3") {
  const test::FinishedRun run = flight("sphere");
  const Vector3d w(0.5, 0.3, 2), n = w.normalized(), along = n.z() * n, p = Vector3d::UnitZ() - along, q = n.cross(p);
  const double W = w.norm(), push = run.parameter("F") / run.parameter("m");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i];
    const Vector3d x =
        push * (along * t * t / 2 + (1 - std::cos(W * t)) / (W * W) * p + (t / W - std::sin(W * t) / (W * W)) * q);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(run.rows.at(i, "x" + std::to_string(k + 1)) - x[k]) < 1e-9);
  }
}

// H = J w is fixed in space; e3 turns about it with H/J1, and w . e3 is constant.
TEST_CASE("R17: for an axisymmetric body e3 rotates about H with the rate |H|/J1") {
  const test::FinishedRun run = flight("default");
  const Vector3d H(0.5, 0.3, 0.8), n = H.normalized(), along = n.z() * n, p = Vector3d::UnitZ() - along, q = n.cross(p);
  const double W = H.norm(), push = run.parameter("F") / run.parameter("m");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i];
    const Vector3d x =
        push * (along * t * t / 2 + (1 - std::cos(W * t)) / (W * W) * p + (t / W - std::sin(W * t) / (W * W)) * q);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(run.rows.at(i, "x" + std::to_string(k + 1)) - x[k]) < 1e-9);
    CHECK(run.rows.at(i, "B.omega3") == doctest::Approx(2).epsilon(1e-10));
  }
}
