// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

// The same linkage in the plane: three angles, two equations that close the loop.
const char* planar = R"toml(format = 1
[parameters]
l0 = 1.3
l1 = 0.5
l2 = 1.2
l3 = 0.9
m1 = 1
m2 = 2
m3 = 1.5
g = 9.81
[coordinates]
alpha = {}
psi = {}
beta = {}
[energy]
kinetic = "(m1/3 + m2)*l1^2/2*alpha_dot^2 + m2*l2^2/6*psi_dot^2 + m2*l1*l2/2*alpha_dot*psi_dot*cos(alpha - psi) + m3*l3^2/6*beta_dot^2"
potential = "g*((m1/2 + m2)*l1*sin(alpha) + m2*l2/2*sin(psi) + m3*l3/2*sin(beta))"
[[constraint]]
name = "along"
holonomic = "l1*cos(alpha) + l2*cos(psi) - l0 - l3*cos(beta)"
[[constraint]]
name = "across"
holonomic = "l1*sin(alpha) + l2*sin(psi) - l3*sin(beta)"
[scene.default]
t = [0, 3]
initial = { alpha = 1, alpha_dot = 2 }
guess = { psi = 0.3, beta = 1.5 }
)toml";

}  // namespace

TEST_CASE(
    "four_bar: of ten equations of spatial pins seven keep multipliers, and the motion is that of the planar linkage") {
  const std::string path = test::build_folder() + "/four_bar_planar.toml";
  write_text(path, planar);
  const auto tighten = [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  };
  const FinishedRun flat = run_model(path, tighten), spatial = run_model("four_bar_spatial_pins", tighten);
  const mechanics::Mechanics& m = spatial.simulation.derived->mechanics;
  CHECK(m.degrees_of_freedom() == 1);
  CHECK(m.active.size() == 7);
  // The crank goes round, and tolerances of 1e-12 leave some 1e-10 at the end.
  for (const char* name : {"alpha", "psi", "beta", "alpha_dot", "psi_dot", "beta_dot"}) {
    CAPTURE(name);
    CHECK(std::abs(flat.final(name) - spatial.final(name)) < 1e-9);
  }
  for (const char* name : {"z", "theta", "phi"}) CHECK(std::abs(spatial.final(name)) < 1e-13);
  CHECK(spatial.drift("energy") < 1e-11);
  CHECK(spatial.simulation.result.constraint_drift < 1e-13);
  // Of the force on the rocker the planar multipliers are the components: lambda dpsi/dbeta.
  CHECK(std::abs(spatial.final("reaction.C.1") + flat.final("reaction.along")) < 1e-8);
  CHECK(std::abs(spatial.final("reaction.C.2") + flat.final("reaction.across")) < 1e-8);
}

TEST_CASE("four_bar: undetermined reactions out of the plane are not reported") {
  const FinishedRun run = run_model("four_bar_spatial_pins");
  const auto& joints = run.simulation.derived->mechanics.joints;
  REQUIRE(joints.size() == 2);
  const std::array<bool, 6> in_the_plane{true, true, false, false, false, true};
  for (const mechanics::JointReaction& joint : joints) CHECK(joint.determined == in_the_plane);
  for (const auto& [name, value] : run.simulation.result.final) {
    for (const char* hidden :
         {"reaction.B.3", "reaction.B.4", "reaction.B.5", "reaction.C.3", "reaction.C.4", "reaction.C.5"})
      CHECK(name != hidden);
  }
}
