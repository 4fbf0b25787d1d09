// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

void tighten_linkage(pipeline::SimulationRequest& request) { request.overrides.rtol = request.overrides.atol = 1e-12; }

// Runs of 2 s at 1e-12 with motions of the order of 1.
constexpr double same_motion = 1e-9;

void replace(std::string& text, const std::string& old, const std::string& with) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  text.replace(at, old.size(), with);
}

/// The shipped model without the joint, which is replaced by relative coordinates of the second body.
std::string built_in(const std::string& name) {
  std::string text = read_text(model_path(name));
  const std::size_t joint = text.find("[[joint]]"), next = text.find("[definitions]");
  text.erase(joint, next - joint);
  replace(text, "{ cartesian = [\"x2\", \"y2\", \"z2\"] }", "\"first + a1*first.e1 + a2*second.e1\"");
  const std::size_t reaction = text.find("\"reaction.");
  text.erase(reaction, text.find("\"F1\"") - reaction);
  return text;
}

FinishedRun run_text(const std::string& name, const std::string& text) {
  const std::string path = test::build_folder() + "/" + name + ".toml";
  write_text(path, text);
  return run_model(path, tighten_linkage);
}

void check_balance(const FinishedRun& run, const std::string& joint) {
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    for (const char* k : {"1", "2", "3"}) {
      CHECK(std::abs(run.rows.at(i, "reaction." + joint + "." + k) - run.rows.at(i, std::string("F") + k)) <
            same_motion);  // Newton's law of the second
      CHECK(std::abs(run.rows.at(i, std::string("H") + k) - run.rows.at(0, std::string("H") + k)) <
            same_motion);  // no external force
    }
  }
  CHECK(run.drift("energy") < 1e-11);
}

}  // namespace

TEST_CASE("R15: a ball joint gives the same motion as relative coordinates, angles 1-3-1") {
  const FinishedRun joint = run_model("R15_ball_joint", tighten_linkage),
                    tree = run_text("R15_ball_built_in", built_in("R15_ball_joint"));
  CHECK(joint.simulation.derived->mechanics.degrees_of_freedom() == 9);
  check_balance(joint, "ball");
  for (const char* moment : {"reaction.ball.4", "reaction.ball.5", "reaction.ball.6"}) CHECK(joint.final(moment) == 0);
  for (const char* name : {"x1", "y1", "z1", "psi", "theta", "phi", "n1", "n2", "n3", "n1_dot", "n2_dot", "n3_dot"}) {
    CAPTURE(name);
    CHECK(std::abs(joint.final(name) - tree.final(name)) < same_motion);
  }
}

TEST_CASE("R15: a pin gives the same motion as a relative angle, angles 3-2-1") {
  std::string text = built_in("R15_pin_joint");
  replace(text, "{ euler = \"321\", angles = [\"n1\", \"n2\", \"n3\"] }",
          "{ axis = \"first.e3\", angle = \"q\" }\nrelative_to = \"first\"");
  replace(text, "n1 = 1.1,", "q = 0.8,");        // n1 - psi
  replace(text, "n1_dot = 2,", "q_dot = 1.5,");  // n1_dot - psi_dot, since e3 = E3 at the start
  replace(text, "guess = { n2 = 0, n3 = 0 }", "");
  const FinishedRun joint = run_model("R15_pin_joint", tighten_linkage), tree = run_text("R15_pin_built_in", text);
  CHECK(joint.simulation.derived->mechanics.degrees_of_freedom() == 7);
  check_balance(joint, "pin");
  for (const char* name : {"x1", "y1", "z1", "psi", "theta", "phi", "x1_dot", "psi_dot", "theta_dot", "phi_dot"}) {
    CAPTURE(name);
    CHECK(std::abs(joint.final(name) - tree.final(name)) < same_motion);
  }
}

TEST_CASE("R15: two bodies with a spring (7.65) conserve energy, linear and angular momentum; angles 3-2-1") {
  const FinishedRun run = run_model("R15_spring", tighten_linkage);
  CHECK(run.simulation.derived->mechanics.degrees_of_freedom() == 12);
  for (const char* name :
       {"energy", "linear_momentum.E1", "angular_momentum.E1", "angular_momentum.E2", "angular_momentum.E3"}) {
    CAPTURE(name);
    CHECK(run.drift(name) < 1e-10);
  }
}
