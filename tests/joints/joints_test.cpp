// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of joint in the registry: degrees of freedom, the certificate (d'Alembert's principle from the model
// alone), and the reactions, checked with Newton's and Euler's equations of the carried body.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "joints/joint.hpp"
#include "joints/rod_on_base.hpp"
#include "mechanics/mechanics.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

FinishedRun run_text(const std::string& name, const std::string& text) {
  const std::string path = test::build_folder() + "/" + name + ".toml";
  write_text(path, text);
  return run_model(path);
}

const std::string start = "u = 0, a = 0.2, u_dot = 0.3, psi = 0.3, theta = 0.4, phi = 0";

bool slides(const joints::Joint& kind) { return kind.name == "slider" || kind.name == "cylindrical"; }

std::string of_kind(const joints::Joint& kind) {
  std::string lines =
      "type = \"" + kind.name + "\"\nbodies = [\"base\", \"rod\"]\n" + (slides(kind) ? "at = \"tip\"\n" : at_tip);
  if (kind.axes == joints::AxisLayout::shared) lines += "axis = \"E1 + 2*E2 - 2*E3\"\n";
  if (kind.axes == joints::AxisLayout::crossed) lines += "axis = [\"base.e3\", \"rod.e2\"]\n";
  return lines;
}

// Motion and reactions are smooth and of the order of 10; rtol of the scene is 1e-9. Reactions are algebraic in the
// state.
constexpr double agreed = 1e-9;

}  // namespace

TEST_CASE("every joint leaves the degrees of freedom of its kind, and its reactions obey Newton and Euler") {
  const std::map<std::string, long> freedom{{"ball", 3},        {"pin", 1},       {"slider", 1},
                                            {"cylindrical", 2}, {"universal", 2}, {"fixed", 0}};
  REQUIRE(joints::registry().size() == freedom.size());
  for (const joints::Joint& kind : joints::registry()) {
    CAPTURE(kind.name);
    const FinishedRun run =
        run_text("joint_" + kind.name, rod_on_base(of_kind(kind), start + (slides(kind) ? ", x_dot = 0.5" : "")));
    CHECK(run.simulation.derived->mechanics.degrees_of_freedom() == 2 + freedom.at(kind.name));
    CHECK(run.simulation.certificate.pass);
    CHECK(run.simulation.result.power_balance < 1e-8);
    CHECK(run.simulation.result.constraint_drift < 1e-12);
    REQUIRE(run.rows.size() == 11);
    double largest = 0;
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      for (const char* k : {"1", "2", "3", "4", "5", "6"}) {
        const double reaction = run.rows.at(i, std::string("reaction.j.") + k);
        CHECK(std::abs(reaction - run.rows.at(i, std::string("N") + k)) < agreed);
        largest = std::max(largest, std::abs(reaction));
      }
    }
    CHECK(largest > 1);  // the reactions are not trivial
  }
}

TEST_CASE("points and axes given at the start are equal to those given by two entries") {
  // At the start the tip is at base + L/5 base.e1, and E3 is the axis of the base.
  const std::string placed =
      "u = 0.1, a = 0.2, u_dot = 0.3, psi = 0.3, theta = 0.4, phi = 0, x = 0.5, y = 0.4, z = -0.1";
  const std::string pin = "type = \"pin\"\nbodies = [\"base\", \"rod\"]\n";
  const FinishedRun one = run_text("joint_placed", rod_on_base(pin + "at = [0.2, 0.3, 0.4]\naxis = \"E3\"\n", placed));
  // The same point and axis, written out along the axes of the rod: Q^T (p - r), Q^T E3 at psi = 0.3, theta = 0.4.
  const double c = std::cos(0.3), s = std::sin(0.3), C = std::cos(0.4), S = std::sin(0.4), d[3] = {-0.3, -0.1, 0.5};
  char rod[200], base[200], axis[100];
  std::snprintf(rod, sizeof rod, "rod + (%.17g)*rod.e1 + (%.17g)*rod.e2 + (%.17g)*rod.e3",
                C * (c * d[0] + s * d[1]) - S * d[2], -s * d[0] + c * d[1], S * (c * d[0] + s * d[1]) + C * d[2]);
  std::snprintf(base, sizeof base, "base + (%.17g)*base.e1 + (%.17g)*base.e2 + 0.4*base.e3",
                std::cos(0.2) * 0.1 + std::sin(0.2) * 0.3, -std::sin(0.2) * 0.1 + std::cos(0.2) * 0.3);
  std::snprintf(axis, sizeof axis, "(%.17g)*rod.e1 + (%.17g)*rod.e3", -S, C);
  const FinishedRun two = run_text(
      "joint_written",
      rod_on_base(pin + "at = [\"" + base + "\", \"" + rod + "\"]\naxis = [\"base.e3\", \"" + axis + "\"]\n", placed));
  for (const char* name : {"u", "a", "x", "y", "z", "psi_dot", "theta_dot", "phi_dot", "reaction.j.1", "reaction.j.2",
                           "reaction.j.3", "reaction.j.6"}) {
    CAPTURE(name);
    CHECK(std::abs(one.final(name) - two.final(name)) < 1e-8);
  }
}

TEST_CASE("E3 is the axis of a planar pin for a body that never turns, too") {
  // The slider of a crank: its axes are E1, E2, E3.
  const auto crank = [](const std::string& axis) {
    return model::read_model_text(
        "format = 1\n[coordinates]\ns = \"m\"\n[[body]]\nname = \"rod\"\nmass = 1\ninertia = 0.02\nposition = { "
        "cartesian = "
        "[\"x\", \"y\"] }\nrotation = { axis = \"E3\", angle = \"b\" }\n[[body]]\nname = \"slide\"\nmass = 1\ninertia "
        "= "
        "0.01\nposition = [\"s\", 0, 0]\nrotation = { fixed = true }\n[[body]]\nname = \"arm\"\nmass = 1\ninertia = "
        "0.01\nrelative_to = \"slide\"\nrotation = { axis = \"E3\", angle = \"c\" }\nposition = \"slide + "
        "0.1[m]*arm.e1\"\n[[joint]]\nname = \"j\"\ntype = \"pin\"\nbodies = [\"rod\", \"slide\"]\nat = [\"rod + "
        "0.15[m]*rod.e1\", \"slide\"]\naxis = [\"E3\", \"" +
            axis + "\"]\n",
        "crank.toml");
  };
  const model::Model in_space = crank("E3"), in_slide = crank("slide.e3");
  CHECK(mechanics::build_mechanics(in_space).constraints.size() ==
        mechanics::build_mechanics(in_slide).constraints.size());
}

TEST_CASE("reactions may be given along the axes of a body") {
  const joints::Joint& pin = *joints::find("pin");
  const FinishedRun run = run_text("joint_axes", rod_on_base(of_kind(pin) + "axes = \"rod\"\n"));
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    CHECK(std::abs(run.rows.at(i, "reaction.j.1") - run.rows.at(i, "B1")) < agreed);
    CHECK(std::abs(run.rows.at(i, "reaction.j.6") - run.rows.at(i, "B6")) < agreed);
  }
}

TEST_CASE("equations that hold identically have no multiplier; undetermined reactions are rejected") {
  const std::string planar =
      "position = { cartesian = [\"x\", \"y\"] }\nrotation = { axis = \"E3\", angle = \"psi\" }\n";
  const std::string joint = "type = \"pin\"\nbodies = [\"base\", \"rod\"]\n" + at_tip + "axis = \"E3\"\n",
                    at_rest = "u = 0, a = 0.2, psi = 0.3";
  const FinishedRun run = run_text("joint_planar", rod_on_base(joint, at_rest, planar));
  const mechanics::Mechanics& m = run.simulation.derived->mechanics;
  CHECK(m.degrees_of_freedom() == 3);
  CHECK(m.active.size() == 2);
  const std::array<bool, 6> determined{true, true, false, false, false, true};
  CHECK(m.joints[0].determined == determined);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    for (const char* k : {"1", "2", "6"})
      CHECK(std::abs(run.rows.at(i, std::string("reaction.j.") + k) - run.rows.at(i, std::string("N") + k)) < agreed);
  }
  std::string text = rod_on_base(joint, at_rest, planar);
  text.replace(text.find("\"reaction.j\""), 12, "\"reaction.j.4\"");
  try {
    run_text("joint_planar_asked", text);
    FAIL("not refused");
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find("the motion does not determine 'reaction.j.4'") != std::string::npos);
    CHECK(error.where().line > 0);
  }
}
