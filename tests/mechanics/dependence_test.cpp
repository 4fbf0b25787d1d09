// SPDX-License-Identifier: GPL-3.0-or-later
// Redundant constraints: which are dropped, which forces the motion then determines, and which models are rejected.
#include <doctest/doctest.h>

#include <map>

#include "mechanics/mechanics.hpp"
#include "support/mechanisms.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Built {
  explicit Built(const std::string& text)
      : model(model::read_model_text(text, "dependent.toml")), m(mechanics::build_mechanics(model)) {}

  std::string of(mechanics::Redundancy need) const {
    std::string list;
    for (const mechanics::Constraint& c : m.constraints) {
      if (c.redundancy == need) list += (list.empty() ? "" : " ") + c.label;
    }
    return list;
  }
  std::string undetermined() const {
    std::string list;
    for (const mechanics::Constraint& c : m.constraints) {
      if (!c.determined) list += (list.empty() ? "" : " ") + c.label;
    }
    return list;
  }

  model::Model model;
  mechanics::Mechanics m;
};

std::string refusal_of(const std::string& text) {
  try {
    const Built built(text);
  } catch (const Error& error) {
    CHECK(error.where().line > 0);
    CHECK_FALSE(error.remedy().empty());
    return error.message();
  }
  return "accepted";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A platform in a plane on cranks of the given lengths, whose bearings lie on one line.
std::string cranks(const std::vector<std::string>& lengths, const std::string& parameters) {
  std::string text = "format = 1\n[parameters]\nm = 1\n" + parameters +
                     "[[body]]\nname = \"P\"\nmass = \"m\"\ninertia = 1\n"
                     "position = { cartesian = [\"x\", \"y\"] }\nrotation = { axis = \"E3\", angle = \"phi\" }\n";
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const std::string at = std::to_string(k);
    text += "[[constraint]]\nname = \"crank" + at + "\"\nholonomic = \"dot(P + " + at + "*P.e1 - " + at + "*E1, P + " +
            at + "*P.e1 - " + at + "*E1) - " + lengths[k] + "^2\"\n";
  }
  return text + "[scene.default]\ninitial = { phi = 0, x = 0.3 }\nguess = { y = 1 }\n";
}

}  // namespace

TEST_CASE(
    "two wheels roll on one axle: the second wheel's equations of the axle's height and lateral slip repeat the "
    "first's") {
  const Built built(wheels_on_one_axle("z"));
  CHECK(built.of(mechanics::Redundancy::redundant) == "right.2 right.3");
  CHECK(built.m.degrees_of_freedom() == 2);
  // Lateral forces are shared in some way, and lateral is neither along E1 nor along E2.
  CHECK(built.undetermined() == "left.1 left.2 left.3 right.1 right.2 right.3");
}

TEST_CASE(
    "a body rolls at constant height: the distance from the plane is an identity, and its force is undetermined") {
  const Built built(wheels_on_one_axle("R"));
  CHECK(built.of(mechanics::Redundancy::identity) == "left.3 right.3");
  CHECK(built.of(mechanics::Redundancy::redundant) == "right.2");
  CHECK(built.m.degrees_of_freedom() == 2);
  CHECK(built.undetermined() == "left.1 left.2 left.3 right.1 right.2 right.3");
}

TEST_CASE("wheels of different radii on one level axle are rejected") {
  CHECK(has(refusal_of(wheels_on_one_axle("z", "R", "2*R")), "'right.3' fixes nothing"));
}

TEST_CASE("Bricard's mechanism has one degree of freedom with as many constraints as coordinates") {
  for (const std::string& text : {bricard_by_products(), bricard_by_distances()}) {
    const Built built(text);
    CHECK(built.m.q.size() == built.m.constraints.size());
    CHECK(built.m.degrees_of_freedom() == 1);
    std::size_t redundant = 0;
    for (const mechanics::Constraint& c : built.m.constraints)
      redundant += c.redundancy == mechanics::Redundancy::redundant;
    CHECK(redundant == 1);
    CHECK_FALSE(built.undetermined().empty());
  }
}

TEST_CASE("Bennett's loop has one degree of freedom with more scalar equations than coordinates") {
  const Built built(bennett_by_products());
  CHECK(built.m.constraints.size() == 4);
  CHECK(built.m.degrees_of_freedom() == 1);
}

TEST_CASE("more constraints than coordinates without a configuration where all hold are rejected") {
  std::string open = bennett_by_products();
  open.replace(open.find("b = \"a*sin"), 28, "b = \"3*a\"");
  CHECK(has(refusal_of(open), "no configuration is found in which all hold"));
}

TEST_CASE("three parallel cranks move a platform if they are equal for all values of the parameters") {
  const Built built(cranks({"L", "L", "L"}, "L = 1\n"));
  CHECK(built.m.degrees_of_freedom() == 1);
  CHECK(built.undetermined() == "crank0 crank1 crank2");
  CHECK(has(refusal_of(cranks({"L", "M", "L"}, "L = 1\nM = 1\n")), "for these values of the parameters only"));
  CHECK(Built(cranks({"L", "L"}, "L = 1\n")).m.degrees_of_freedom() == 1);
  CHECK(Built(cranks({"L", "L"}, "L = 1\n")).undetermined().empty());
}

TEST_CASE("the unit length of Euler parameters is redundant if another body's parameters are constrained to them") {
  std::string text = "format = 1\n";
  for (const std::string b : {"A", "B"}) {
    text += "[[body]]\nname = \"" + b +
            "\"\nmass = 1\ninertia = { principal = [1, 1.2, 1.4] }\nrotation = { euler_parameters = [";
    for (const std::string k : {"0", "1", "2", "3"}) text += "\"" + b + "p" + k + "\"" + (k == "3" ? "] }\n" : ", ");
  }
  for (const std::string k : {"0", "1", "2", "3"})
    text += "[[constraint]]\nname = \"c" + k + "\"\nholonomic = \"Ap" + k + " - Bp" + k + "\"\n";
  const Built built(text + "[scene.default]\ninitial = { Ap1 = 0.3, Ap2 = 0.2 }\n");
  CHECK(built.m.degrees_of_freedom() == 3);
}

TEST_CASE("a constraint that the user can omit is rejected if all its equations repeat others") {
  const std::string text = wheels_on_one_axle("z");
  const std::string again =
      "[[constraint]]\nname = \"again\"\nrolling = { body = \"L\", at = \"-R*E3\", on = \"ground\" }\n[scene.default]";
  std::string twice = text;
  twice.replace(twice.find("[scene.default]"), 15, again);
  CHECK(has(refusal_of(twice), "'again."));
}

TEST_CASE("an event cannot wait for a force that the motion does not determine") {
  std::string text = wheels_on_one_axle("z");
  text += "[[event]]\nname = \"lifts\"\nwhen = \"reaction.left.3\"\n";
  CHECK(has(refusal_of(text), "does not determine the force of 'left.3'"));
}
