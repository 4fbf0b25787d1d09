// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates have ranges: a start outside is rejected, a run that leaves one reports it.
#include <doctest/doctest.h>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

// Motion through the centre: r would become negative, and the length of the spring is then not r.
std::string radial(double r, double r_dot) {
  return "format = 1\n[parameters]\nm = 1\nk = 4\nL = 0.5\n[[particle]]\nname = \"P\"\nmass = \"m\"\n"
         "position = { cylindrical = [\"r\", \"theta\"] }\n"
         "[[force]]\nspring = { between = [\"P\", \"origin\"], stiffness = \"k\", length = \"L\" }\n"
         "[scene.default]\nt = [0, 10]\ninitial = { r = " +
         std::to_string(r) + ", r_dot = " + std::to_string(r_dot) + " }\n";
}

test::FinishedRun run_text(const std::string& text) {
  const std::string path = test::build_folder() + "/radial.toml";
  test::write_text(path, text);
  return test::run_model(path);
}

}  // namespace

TEST_CASE("run: a radius that would pass zero ends the run with chart_left, the last row inside the chart") {
  const test::FinishedRun finished = run_text(radial(1, -5));
  CHECK(finished.simulation.result.outcome == eom::Outcome::chart_left);
  CHECK(finished.simulation.result.detail.find("r leaves its range") != std::string::npos);
  CHECK(finished.final("r") > 0);
  CHECK(finished.rows.at(finished.rows.size() - 1, "r") > 0);
  CHECK(finished.simulation.result.error_estimate.empty());
}

TEST_CASE("run: a run that stays inside its range is done") {
  CHECK(run_text(radial(1, 0)).simulation.result.outcome == eom::Outcome::done);
}

TEST_CASE("run: a start outside the range is rejected") {
  CHECK_THROWS_WITH_AS(run_text(radial(-1, 0)), doctest::Contains("the start has r = -1, outside its range (0, inf)"),
                       Error);
}

TEST_CASE("run: a bead on a rotating wire passes through the centre, where its equation is regular") {
  const test::FinishedRun finished = run_text(
      "format = 1\n[parameters]\nm = 1\nw = 1\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cylindrical = "
      "[\"r\", \"theta\"] }\n"
      "[[constraint]]\nname = \"turn\"\nholonomic = \"theta - w*t\"\n[scene.default]\nt = [0, 2]\ninitial = { r = 0.5, "
      "r_dot = -1 }\n");
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(std::abs(finished.final("r") - (0.5 * std::cosh(2.0) - std::sinh(2.0))) < 1e-7);
  // With a spring to the centre the distance is r on one side and -r on the other.
  const test::FinishedRun spring = run_text(
      "format = 1\n[parameters]\nm = 1\nw = 1\nk = 9\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { "
      "cylindrical = [\"r\", \"theta\"] }\n"
      "[[force]]\nspring = { between = [\"P\", \"origin\"], stiffness = \"k\", length = 0.1 }\n"
      "[[constraint]]\nname = \"turn\"\nholonomic = \"theta - w*t\"\n[scene.default]\nt = [0, 2]\ninitial = { r = 0.5, "
      "r_dot = -1 }\n");
  CHECK(spring.simulation.result.outcome == eom::Outcome::chart_left);
  CHECK(spring.simulation.result.detail.find("give it a wider one in [coordinates]") != std::string::npos);
}

TEST_CASE("run: a pendulum that rotates through the poles of its coordinates has two azimuths, at every tolerance") {
  // phi_dot^2 > 4 g: it goes over the top. With an azimuth rate it would not meet the poles.
  for (const double start : {0.0, 0.3, -2.0}) {
    for (const double rtol : {1e-6, 1e-9, 1e-11, 1e-13}) {
      CAPTURE(start);
      CAPTURE(rtol);
      const std::string path = test::build_folder() + "/poles.toml";
      test::write_text(
          path,
          "format = 1\n[parameters]\ng = 9.81\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { spherical "
          "= [\"R\", \"phi\", \"theta\"] }\n[[force]]\ngravity = \"-g*E3\"\n[[constraint]]\nname = "
          "\"rod\"\nholonomic = \"R - 1\"\n[scene.default]\nt = [0, 10]\ninitial = { phi = 1.5, phi_dot = 7, "
          "theta = " +
              std::to_string(start) + " }\n");
      const test::FinishedRun finished = test::run_model(path, [&](pipeline::SimulationRequest& request) {
        request.overrides.rtol = rtol;
        request.overrides.atol = 1e-3 * rtol;
      });
      REQUIRE(finished.simulation.result.outcome == eom::Outcome::done);
      int poles = 0;
      double first = 0;
      for (const run::RunEvent& event : finished.simulation.result.events) {
        if (event.kind != "pole") continue;
        if (poles++ == 0) first = event.t;
      }
      CHECK(poles > 10);
      const double pi = 3.14159265358979323846;
      // The pole is located: phi_dot^2 + 2 g cos(phi) is constant, and the time to phi = pi an integral (Simpson's
      // rule).
      const auto slowness = [](double phi) { return 1 / std::sqrt(49 + 2 * 9.81 * (std::cos(1.5) - std::cos(phi))); };
      constexpr int panels = 2000;
      double passage = 0;
      for (int i = 0; i < panels; ++i) {
        const double h = (pi - 1.5) / panels, at = 1.5 + i * h;
        passage += h / 6 * (slowness(at) + 4 * slowness(at + h / 2) + slowness(at + h));
      }
      constexpr double steps = 10;  // as many errors of rtol add up before the first passage
      CHECK(std::abs(first - passage) < steps * rtol + 1e-10);
      const double turned = finished.final("theta") - start;
      CHECK(std::abs(turned - (poles % 2 == 0 ? 0 : pi)) < 1e-5);
      CHECK(finished.simulation.result.error_estimate.back().second < 1e-2);
    }
  }
}
