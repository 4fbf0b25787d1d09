// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("R8: the constrained energies are (9.99)") {
  DisplayedModel r8("R8_pendulum_body");
  const reading::DisplayForm two = r8.form(system::Approach::two);
  const Sum phi = r8("phi_dot"), theta = r8("theta_dot"), n = r8("theta");
  CHECK(same(two.kinetic, half(r8("J1") * square(phi * cos(n)) + r8("J") * (square(theta) + square(phi * sin(n))))));
  CHECK(same(two.potential, -(r8("m") * r8("g") * r8("L") * cos(n))));
}

TEST_CASE(
    "R8: the joint force satisfies Newton's law, the moment without spin Euler's, and the motion is the same without "
    "the joint") {
  const auto tighten = [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = request.overrides.atol = 1e-12;
  };
  const FinishedRun free = run_model("R8_pendulum_body", tighten), joint = run_model("R8_pendulum_body_joint", tighten);
  for (const char* name : {"phi", "theta", "phi_dot", "theta_dot"})
    CHECK(std::abs(free.final(name) - joint.final(name)) < 1e-9);
  CHECK(free.drift("energy") < 1e-11);
  CHECK(free.drift("momentum.phi") < 1e-11);
  double greatest = 0;
  for (const FinishedRun* run : {&free, &joint}) {
    for (std::size_t i = 0; i < run->rows.size(); ++i) {
      CHECK(std::abs(run->rows.at(i, "reaction.no_spin") - run->rows.at(i, "spin_moment")) < 1e-11);
      greatest = std::max(greatest, std::abs(run->rows.at(i, "spin_moment")));
      if (run == &free) continue;
      for (const char* k : {"1", "2", "3"}) {
        CHECK(std::abs(run->rows.at(i, std::string("reaction.joint.") + k) -
                       run->rows.at(i, std::string("newton") + k)) < 1e-10);
      }
    }
  }
  CHECK(greatest > 0.01);  // "no spin" is not w . e1 = 0
}
