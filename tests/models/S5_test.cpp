// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "print/render.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

constexpr double swing_tolerance =
    1e-8;  // ten seconds at rtol 1e-12: errors of 1e-12 grow by some 1e2 to 1e3 in this swing

void tighten_swing(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-12;
  request.overrides.atol = 1e-12;
}

}  // namespace

TEST_CASE("S5: polar coordinates without rods and Cartesian ones with multipliers give the same motion and tension") {
  const test::FinishedRun polar = test::run_model("S5_double_pendulum", tighten_swing);
  const test::FinishedRun cartesian = test::run_model("S5_double_pendulum_cartesian", tighten_swing);
  REQUIRE(polar.rows.size() == cartesian.rows.size());
  CHECK(cartesian.simulation.derived->mechanics.active.size() == 2);
  CHECK(polar.simulation.derived->mechanics.active.empty());
  double worst = 0, worst_rod = 0, scale = 0;
  for (std::size_t i = 0; i < polar.rows.size(); ++i) {
    const double th1 = polar.rows.at(i, "theta1"), th2 = polar.rows.at(i, "theta2");
    const double x1 = std::cos(th1), y1 = std::sin(th1), x2 = x1 + std::cos(th2), y2 = y1 + std::sin(th2);
    worst = std::max({worst, std::abs(cartesian.rows.at(i, "x1") - x1), std::abs(cartesian.rows.at(i, "y1") - y1),
                      std::abs(cartesian.rows.at(i, "x2") - x2), std::abs(cartesian.rows.at(i, "y2") - y2)});
    // lambda e_r against lambda r with |r| = 1: the same number.
    for (const char* rod : {"reaction.rod1", "reaction.rod2"}) {
      worst_rod = std::max(worst_rod, std::abs(polar.rows.at(i, rod) - cartesian.rows.at(i, rod)));
      scale = std::max(scale, std::abs(polar.rows.at(i, rod)));
    }
  }
  CHECK(worst < swing_tolerance);
  CHECK(worst_rod < swing_tolerance * scale);
  CHECK(cartesian.simulation.result.constraint_drift < 1e-13);
  CHECK(polar.drift("energy") < 1e-10);
  CHECK(cartesian.drift("energy") < 1e-10);
}

TEST_CASE("S5: approach I and approach II give the same motion, planar and spherical") {
  for (const char* name : {"S5_double_pendulum", "S5_spherical_double_pendulum"}) {
    const auto run = [&](pipeline::ApproachChoice approach) {
      return test::run_model(name, [&](pipeline::SimulationRequest& request) {
        tighten_swing(request);
        request.approach = approach;
        request.overrides.t_end = 3;
      });
    };
    const test::FinishedRun one = run(pipeline::ApproachChoice::one), two = run(pipeline::ApproachChoice::two);
    for (const auto& [key, value] : one.simulation.result.final) {
      const auto& shown = key;
      INFO(name, " ", shown);
      CHECK(std::abs(value - two.final(key)) < swing_tolerance * (1 + std::abs(value)));
    }
  }
}

TEST_CASE("S5: the spherical double pendulum conserves E and the vertical angular momentum") {
  const test::FinishedRun run =
      test::run_model("S5_spherical_double_pendulum", [](pipeline::SimulationRequest& request) {
        tighten_swing(request);
        request.overrides.outputs = {"P1.position1", "P1.position2", "P1.velocity1", "P1.velocity2",
                                     "P2.position1", "P2.position2", "P2.velocity1", "P2.velocity2"};
      });
  const auto h = [&](std::size_t i) {
    const auto about_vertical = [&](const std::string& P) {
      return run.rows.at(i, P + ".position1") * run.rows.at(i, P + ".velocity2") -
             run.rows.at(i, P + ".position2") * run.rows.at(i, P + ".velocity1");
    };
    return run.parameter("m1") * about_vertical("P1") + run.parameter("m2") * about_vertical("P2");
  };
  CHECK(run.drift("energy") < 1e-10);
  CHECK(std::abs(h(0)) > 1);
  for (std::size_t i = 0; i < run.rows.size(); ++i) CHECK(h(i) == doctest::Approx(h(0)).epsilon(1e-9));
}

TEST_CASE("S5: a spherical double pendulum that starts in a plane moves as the planar one") {
  const test::FinishedRun planar = test::run_model("S5_double_pendulum", [](pipeline::SimulationRequest& request) {
    tighten_swing(request);
    request.overrides.t_end = 3;
    request.overrides.values = {{"m2", symbolic::Rational(1) / 2}, {"L2", symbolic::Rational(4) / 5}};
  });
  const std::string text = R"toml(format = 1
[parameters]
m1 = 1
m2 = 0.5
L1 = 1
L2 = 0.8
g = 9.81
[[particle]]
name = "P1"
mass = "m1"
position = { spherical = ["R1", "phi1", "theta1"] }
[[particle]]
name = "P2"
mass = "m2"
position = { spherical = ["R2", "phi2", "theta2"], from = "P1" }
[[force]]
gravity = "g*E1"
[[constraint]]
name = "rod1"
holonomic = "R1 - L1"
[[constraint]]
name = "rod2"
holonomic = "R2 - L2"
[scene.default]
t = [0, 3]
initial = { phi1 = "pi/2", phi2 = "pi/2", theta1 = 0.8, theta2 = 0.4 }
)toml";
  // Gravity along E1 and both angles phi at pi/2: theta are the angles of the planar model.
  const std::string path = test::build_folder() + "/S5_turned.toml";
  test::write_text(path, text);
  const test::FinishedRun spherical = test::run_model(path, tighten_swing);
  for (const char* name : {"theta1", "theta2", "theta1_dot", "theta2_dot", "reaction.rod1", "reaction.rod2"}) {
    INFO(name);
    CHECK(spherical.final(name) == doctest::Approx(planar.final(name)).epsilon(swing_tolerance));
  }
  CHECK(spherical.final("phi1") == doctest::Approx(std::acos(0.0)).epsilon(1e-12));
}

TEST_CASE(
    "S5: a velocity constraint on both masses holds in either approach, and the power balance includes its work") {
  const auto run = [](pipeline::ApproachChoice approach) {
    return test::run_model("S5_double_pendulum_pfaffian", [approach](pipeline::SimulationRequest& request) {
      tighten_swing(request);
      request.approach = approach;
      request.overrides.outputs = {"P1.position1", "P1.position2", "P1.velocity3",
                                   "P2.velocity1", "P2.velocity2", "power"};
    });
  };
  const test::FinishedRun one = run(pipeline::ApproachChoice::one), two = run(pipeline::ApproachChoice::two);
  const double c = one.parameter("c"), w = one.parameter("w"), L1 = one.parameter("L1");
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    const auto y = [&](const char* name) { return one.rows.at(i, name); };
    const double across = (y("P1.position1") * y("P2.velocity2") - y("P1.position2") * y("P2.velocity1")) / L1;
    CHECK(std::abs(y("P1.velocity3") + across / 4 - c * std::sin(w * one.rows.t[i])) <
          1e-11);  // rows lie between steps
  }
  for (const auto& [key, value] : one.simulation.result.final) {
    const auto& shown = key;
    INFO(shown);
    CHECK(std::abs(value - two.final(key)) < swing_tolerance * (1 + std::abs(value)));
  }
  CHECK(one.simulation.result.power_balance < 1e-9);
}

TEST_CASE("S5: the rod below acts on the particle between the rods too: N_1 = lambda_1 e_r1 - lambda_2 e_r2") {
  const test::FinishedRun run = test::run_model("S5_double_pendulum", [](pipeline::SimulationRequest& request) {
    request.overrides.t_end = 2;
    request.overrides.outputs = {"P1.constraint_force1", "P1.constraint_force2", "reaction.rod1", "reaction.rod2"};
  });
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double th1 = run.rows.at(i, "theta1"), th2 = run.rows.at(i, "theta2");
    const double above = run.rows.at(i, "reaction.rod1"), below = run.rows.at(i, "reaction.rod2");
    CHECK(run.rows.at(i, "P1.constraint_force1") ==
          doctest::Approx(above * std::cos(th1) - below * std::cos(th2)).epsilon(1e-11));
    CHECK(run.rows.at(i, "P1.constraint_force2") ==
          doctest::Approx(above * std::sin(th1) - below * std::sin(th2)).epsilon(1e-11));
  }
  const test::DisplayedModel model("S5_double_pendulum");
  const reading::DisplayForm one = reading::derive_display_form(model.s.mechanics, system::Approach::one);
  std::vector<std::string> forces;
  for (const print::PrintedFormula& item : print::render(model.s.mechanics, one, {"reactions"}))
    if (item.role == "constraint force") forces.push_back(item.text);
  CHECK(forces == std::vector<std::string>{"N_1 = lambda_1 e_r1 - lambda_2 e_r2", "N_2 = lambda_2 e_r2"});
}
