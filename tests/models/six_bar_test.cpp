// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

// The linkage with its one coordinate: z = 2 L sin(a), all arms inclined by a, the plate level.
const char* one_coordinate = R"toml(format = 1
[parameters]
L = 0.5
m = 0.4
M = 1.5
g = 9.81
k = 150
l = 0.8
[coordinates]
a = {}
[energy]
kinetic = "2*M*L^2*cos(a)^2*a_dot^2 + m*L^2/3*a_dot^2 + m*L^2*((sin(a)^2 + 9*cos(a)^2)/4 + 1/12)*a_dot^2"
potential = "g*L*sin(a)*(2*M + 4*m) + k/2*(2*L*sin(a) - l)^2"
[scene.default]
t = [0, 2]
initial = { a = 0.6, a_dot = 1 }
)toml";

}  // namespace

TEST_CASE("six_bar: Sarrus' linkage is overconstrained by one, and moves along its straight line") {
  const std::string path = test::build_folder() + "/six_bar_one.toml";
  write_text(path, one_coordinate);
  const auto tighten = [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  };
  const FinishedRun one = run_model(path, tighten), all = run_model("six_bar_spatial", tighten);
  const mechanics::Mechanics& m = all.simulation.derived->mechanics;
  CHECK(m.degrees_of_freedom() == 1);
  CHECK(m.active.size() == 9);
  const double a = one.final("a"), rate = one.final("a_dot");
  // Runs at 1e-12 of an oscillation with rates of the order of 2.
  for (const char* arm : {"a1", "b1"}) CHECK(std::abs(all.final(arm) - a) < 1e-9);
  for (const char* arm : {"a2", "b2"}) CHECK(std::abs(all.final(arm) - (std::numbers::pi - a)) < 1e-9);
  CHECK(std::abs(all.final("a1_dot") - rate) < 1e-9);
  CHECK(std::abs(all.final("z") - std::sin(a)) < 1e-9);
  for (const char* name : {"x", "y", "psi", "theta", "phi"}) CHECK(std::abs(all.final(name)) < 1e-13);
  CHECK(all.drift("energy") < 1e-11);
  CHECK(all.simulation.result.constraint_drift < 1e-13);
  // The pins may twist the plate against one another, whatever the motion is.
  for (const mechanics::JointReaction& joint : m.joints)
    CHECK(joint.determined == std::array<bool, 6>{true, true, true, true, true, false});
}
