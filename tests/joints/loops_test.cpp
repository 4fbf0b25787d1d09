// SPDX-License-Identifier: GPL-3.0-or-later
// Redundant equations of closed loops, and loops that are rejected.
#include <doctest/doctest.h>

#include "mechanics/mechanics.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

std::string changed(const std::string& name, const std::vector<std::pair<std::string, std::string>>& edits) {
  std::string text = read_text(model_path(name));
  for (const auto& [old, with] : edits) {
    const std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    text.replace(at, old.size(), with);
  }
  return text;
}

struct Built {
  model::Model model;
  mechanics::Mechanics mechanics;
  explicit Built(const std::string& text)
      : model(model::read_model_text(text, "loop.toml")), mechanics(mechanics::build_mechanics(model)) {}
  std::size_t redundant() const {
    std::size_t count = 0;
    for (const mechanics::Constraint& c : mechanics.constraints)
      count += c.redundancy == mechanics::Redundancy::redundant;
    return count;
  }
};

std::string refusal_message(const std::string& text) {
  try {
    const Built built(text);
  } catch (const Error& error) {
    CHECK(error.where().line > 0);
    return error.what();
  }
  return "not refused";
}

const std::string pin_axis = "axis = [\"coupler.e3\", \"rocker.e3\"]";

}  // namespace

TEST_CASE("a loop whose dimensions are inexact, or fit only for special parameters, is rejected") {
  CHECK(refusal_message(
            changed("four_bar_spatial_pins", {{pin_axis, "axis = [\"coupler.e3\", \"rocker.e3 + 1e-8*rocker.e1\"]"}}))
            .find("seems to follow from the other constraints") != std::string::npos);
  for (const std::string tilt : {"sin(p - q)", "r"}) {  // parameters that happen to be equal, one that happens to be 0
    const std::string text =
        changed("four_bar_spatial_pins",
                {{pin_axis, "axis = [\"coupler.e3\", \"rocker.e3 + " + tilt + "*rocker.e1\"]"},
                 {"g = \"9.81 m/s^2\"\n", "g = \"9.81 m/s^2\"\np = \"0.5 rad\"\nq = \"0.5 rad\"\nr = 0\n"}});
    CHECK(refusal_message(text).find("for these values of the parameters only") != std::string::npos);
  }
}

TEST_CASE("the redundant equations of a planar loop depend neither on its lengths nor on the start") {
  for (const std::string alpha : {"alpha = 1,", "alpha = 2.5,", "alpha = -0.4,"}) {
    const Built built(changed("four_bar_spatial_pins", {{"alpha = 1,", alpha}, {"l2 = \"1.2 m\"", "l2 = \"1.25 m\""}}));
    CHECK(built.redundant() == 3);
    CHECK(built.mechanics.degrees_of_freedom() == 1);
  }
}

TEST_CASE("with a ball instead of one pin only the rotation of the coupler about its own axis is redundant") {
  const Built built(changed("four_bar_spatial_pins",
                            {{"type = \"pin\"", "type = \"ball\""}, {"axis = [\"crank.e3\", \"coupler.e3\"]\n", ""}}));
  CHECK(built.redundant() == 1);  // both ends of the coupler are in the plane, and so is its axis
  CHECK(built.mechanics.degrees_of_freedom() == 1);
}

TEST_CASE("a constraint of the model takes precedence over an equivalent equation of a joint") {
  const Built built(changed("four_bar_spatial_pins",
                            {{"[[joint]]", "[[constraint]]\nname = \"level\"\nholonomic = \"theta\"\n[[joint]]"}}));
  CHECK(built.mechanics.degrees_of_freedom() == 1);
  for (const mechanics::Constraint& c : built.mechanics.constraints) {
    if (c.name == "level") CHECK(c.redundancy == mechanics::Redundancy::independent);
  }
  CHECK(built.redundant() == 4);
}

TEST_CASE("a second joint between the same bodies is redundant") {
  const std::string twice =
      "[[joint]]\nname = \"D\"\ntype = \"ball\"\nbodies = [\"coupler\", \"rocker\"]\nat = [\"coupler + "
      "l2/2*coupler.e1\", \"rocker + l3/2*rocker.e1\"]\n[scene.default]";
  const Built built(changed("four_bar_spatial_pins", {{"[scene.default]", twice}}));
  CHECK(built.redundant() == 6);
  const mechanics::JointReaction& shared = built.mechanics.joints[2];
  for (std::size_t j = 0; j < 3; ++j) CHECK_FALSE(shared.determined[j]);
}
