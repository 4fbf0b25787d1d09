// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/kepler.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

constexpr double inclination = 30 * 3.14159265358979323846 / 180;
constexpr double tolerance = 1e-9;  // twenty seconds, some three periods, at rtol 1e-12

void tighten(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-12;
  request.overrides.atol = 1e-13;
  request.overrides.outputs = {"energy", "h", "P.position1", "P.position2", "P.position3"};
}

}  // namespace

TEST_CASE("P14: in Cartesian, spherical and parabolic coordinates, Kepler's equation holds and E and h are conserved") {
  for (const char* name : {"P14_kepler_cartesian", "P14_kepler_spherical", "P14_kepler_parabolic"}) {
    INFO(name);
    const test::FinishedRun run = test::run_model(name, tighten);
    const double GM = run.parameter("GM"), a = run.parameter("a"), e = run.parameter("e"), m = run.parameter("m");
    double worst = 0;
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      const test::Orbit orbit = test::kepler(GM, a, e, inclination, run.rows.t[i]);
      worst = std::max({worst, std::abs(run.rows.at(i, "P.position1") - orbit.r[0]),
                        std::abs(run.rows.at(i, "P.position2") - orbit.r[1]),
                        std::abs(run.rows.at(i, "P.position3") - orbit.r[2])});
      CHECK(run.rows.at(i, "h") == doctest::Approx(m * std::sqrt(GM * a * (1 - e * e))).epsilon(tolerance));
    }
    CHECK(worst < tolerance);
    CHECK(run.drift("energy") < 1e-11);
    // In every chart, with and without ignorable coordinates. H.E1 is 0 up to rounding; its drift is relative to
    // |r||v|.
    const bool cyclic = name != std::string("P14_kepler_cartesian");
    for (const char* h :
         {"angular_momentum.E1", "angular_momentum.E2", cyclic ? "momentum.theta" : "angular_momentum.E3"}) {
      CHECK(run.drift(h) < 1e-10);
    }
    CHECK(run.final("energy") == doctest::Approx(-m * GM / (2 * a)).epsilon(tolerance));
  }
}

TEST_CASE("P14: after one period it is back where it started") {
  const double period = 2 * std::acos(-1.0);  // GM = a = 1
  const test::FinishedRun run = test::run_model("P14_kepler_cartesian", [&](pipeline::SimulationRequest& request) {
    tighten(request);
    request.overrides.t_end = period;
  });
  CHECK(run.final("x") == doctest::Approx(0.8).epsilon(tolerance));
  CHECK(std::abs(run.final("y")) < tolerance);
  CHECK(std::abs(run.final("x_dot")) < tolerance);
}
