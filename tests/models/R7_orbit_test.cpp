// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "analysis/steady_search.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using linear::Stability;

namespace {

struct OrbitAttitude {
  double R, rate, radial, along, across;  // moments of inertia by where their axes point; 0 where none does
};

/// The axes of the body in those of the orbit, from its Euler parameters.
OrbitAttitude attitude(const analysis::SteadyMotions& all, const analysis::SteadyMotion& point) {
  const auto value = [&](const std::string& name) {
    const auto& names = all.problem.flow->names();
    return linear::to_double(
        point.l.z[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())]);
  };
  const double a = value("e0"), b = value("e1"), c = value("e2"), d = value("e3"), J[] = {0.003, 0.004, 0.005};
  const double Q[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                          {2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)},
                          {2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d}};
  double moment[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(std::abs(Q[i][k]) - 1) < 1e-9) moment[i] = J[k];
    }
  }
  return {value("R"), value("theta_dot"), moment[0], moment[1], moment[2]};
}

}  // namespace

// Of the decoupled orbit (8.93): pitch s^2 = -3 W^2 (J_along - J_radial)/J_across, roll and yaw s^4 + (1 + 3 a + a b)
// W^2 s^2 + 4 a b W^4 = 0 with a = (J_across - J_radial)/J_along, b = (J_across - J_along)/J_radial. The orbit of the
// full force differs by J/(m R^2).
TEST_CASE(
    "R7_orbit: 24 relative equilibria; the rate is Kepler's up to second order; stable ones have "
    "J_across > J_along > J_radial") {
  analysis::SteadyRequest request;
  request.model = test::model_at(test::model_path("R7_satellite_in_orbit"));
  request.hold = {{"theta_dot", 1}};
  const analysis::SteadyMotions all = analysis::steady_motions(request);
  int count = 0, stable = 0;
  for (const analysis::SteadyMotion& point : all.points) {
    const OrbitAttitude x = attitude(all, point);
    CHECK(x.R > 0.5);  // nearer, the second order says nothing, and the range of R leaves it out
    ++count;
    REQUIRE(x.radial * x.along * x.across > 0);
    // The sum of the moments less three times the radial one: (7.71).
    const double kepler = 1 / std::pow(x.R, 3), full = kepler * (1 + 1.5 * (0.012 - 3 * x.radial) / (x.R * x.R));
    CHECK(x.rate == 1);
    CHECK(x.rate * x.rate == doctest::Approx(full).epsilon(1e-12));
    const double a = (x.across - x.radial) / x.along, b = (x.across - x.along) / x.radial;
    const bool oscillates = x.along > x.radial && a * b > 0 && 1 + 3 * a + a * b > 4 * std::sqrt(a * b);
    CHECK((point.verdict.stability == Stability::unstable) == !oscillates);
    if (x.across > x.along && x.along > x.radial) {
      CHECK(point.verdict.stability == Stability::stable);
      ++stable;
      const double pitch = std::sqrt(3 * (x.along - x.radial) / x.across);
      double nearest = 1;
      for (const linear::Eigenvalue& e : point.l.spectrum.values) nearest = std::min(nearest, std::abs(e.im - pitch));
      CHECK(nearest < 0.03);  // J/(m R^2) is 0.005, some times over
    }
  }
  CHECK(count == 24);
  CHECK(stable == 4);
}

TEST_CASE("R7_orbit: energy and the angular momentum about the axis of the frame are conserved") {
  const test::FinishedRun run = test::run_model("R7_satellite_in_orbit", [](pipeline::SimulationRequest& r) {
    r.overrides.rtol = 1e-11;
    r.overrides.atol = 1e-12;
  });
  CHECK(run.drift("energy") < 1e-9);
  CHECK(run.drift("momentum.theta") < 1e-9);
}
