// SPDX-License-Identifier: GPL-3.0-or-later
// Every misuse of a [[joint]] is reported with its location and a remedy.
#include <doctest/doctest.h>

#include "joints/rod_on_base.hpp"
#include "mechanics/mechanics.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Refusal {
  std::string what, remedy;
  SourceLocation where;
};

Refusal refusal(const std::string& text) {
  try {
    const model::Model model = model::read_model_text(text, "joint.toml");
    mechanics::build_mechanics(model);
  } catch (const Error& error) {
    return {error.what(), error.remedy(), error.where()};
  }
  return {"not refused", "", {}};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string pin = "type = \"pin\"\n", both = "bodies = [\"base\", \"rod\"]\n",
                  axis = "axis = [\"base.e3\", \"rod.e3\"]\n";

}  // namespace

TEST_CASE("misuse of joints is rejected") {
  const struct {
    std::string lines, what, remedy;
  } cases[] = {
      {"type = \"pni\"\n" + both + at_tip + axis, "there is no joint of type 'pni'", "pin"},
      {both + at_tip + axis, "has no type", "type = \"pin\""},
      {pin + "bodies = [\"base\"]\n" + at_tip + axis, "is between 1 bodies", "bodies = [\"A\", \"B\"]"},
      {pin + "bodies = [\"ground\", \"ground\"]\n" + at_tip + axis, "is between 'ground' and itself", "[[body]]"},
      {pin + "bodies = [\"rod\", \"rod\"]\n" + at_tip + axis, "is between 'rod' and itself", "two bodies"},
      {pin + "bodies = [\"base\", \"tip\"]\n" + at_tip + axis, "'tip' is a particle or point, which has no axes",
       "bodies and frames are"},
      {pin + both + axis, "has no at", "at = ["},
      {pin + both + at_tip, "has no axis", "axis = ["},
      {"type = \"ball\"\n" + both + at_tip + axis, "has no axis", "remove 'axis'"},
      {pin + both + "at = [\"base\"]\n" + axis, "'at' of the joint 'j' has 1 entries", "as placed at the start"},
      {pin + both + at_tip + "axis = [\"base.e3\"]\n", "'axis' of the joint 'j' has 1 entries",
       "as placed at the start"},
      {pin + both + at_tip + "axis = [\"rod.e3\", \"rod.e3\"]\n", "this axis is not fixed in 'base'",
       "base.e1, base.e2, base.e3"},
      {pin + both + at_tip + "axis = [\"base.e3 - base.e3\", \"rod.e3\"]\n", "has no direction", "base.e1"},
      {pin + both + "at = [\"base\", \"base\"]\n" + axis, "this point of the joint 'j' is not fixed in its body",
       "[[point]]"},
      {pin + "bodies = [\"ground\", \"rod\"]\nat = [\"base\", \"tip\"]\naxis = [\"E3\", \"rod.e3\"]\n",
       "depends on coordinates", "parameters, functions of time"},
      {"type = \"universal\"\n" + both + at_tip + "axis = [\"base.e3\", \"rod.e3\"]\n",
       "the axes of the joint 'j' are parallel at the start", "right angles"},
      {"type = \"universal\"\n" + both + at_tip + "axis = \"E3\"\n", "has two axes", "axis = [\"A.e1\", \"B.e2\"]"},
      {pin + both + at_tip + axis + "axes = \"rot\"\n", "there is no body or frame 'rot'", "rod"},
      {pin + both + at_tip + axis + "angle = 1\n", "angle", ""},
  };
  for (const auto& c : cases) {
    const Refusal r = refusal(rod_on_base(c.lines, "u = 0, a = 0, psi = 0.3, theta = 0, phi = 0"));
    CAPTURE(c.lines);
    CAPTURE(r.what);
    CAPTURE(r.remedy);
    CHECK(has(r.what, c.what));
    CHECK(has(r.remedy, c.remedy));
    CHECK(r.where.line > 40);  // in the [[joint]], not somewhere else
  }
}

TEST_CASE("a point given at the start needs initial values of coordinates that other constraints determine") {
  const std::string joint = pin + both + "at = \"E1\"\naxis = \"E3\"\n";
  const std::string slot = "[[constraint]]\nname = \"slot\"\nholonomic = \"x - y\"\n";
  std::string text = rod_on_base(joint, "u = 0, a = 0, psi = 0.3, theta = 0, phi = 0");
  CHECK(refusal(text).what == "not refused");
  text.insert(text.find("[[joint]]"), slot);
  const Refusal r = refusal(text);
  CHECK(has(r.what, "the start of 'x' follows from other constraints"));
  CHECK(has(r.remedy, "initial"));
}

TEST_CASE("a reaction that a joint does not have is rejected") {
  std::string text = rod_on_base(pin + both + at_tip + axis);
  text.replace(text.find("\"reaction.j\""), 12, "\"reaction.j.7\"");
  const Refusal r = refusal(text);
  CHECK(has(r.what, "the joint 'j' has no reaction '7'"));
  CHECK(has(r.remedy, "reaction.j.1 to reaction.j.6"));
}
