// SPDX-License-Identifier: GPL-3.0-or-later
// Target modelica through an evaluator of its equations (evaluators.py). tests/models/languages_test.cpp compares
// shipped models with their C code.
#include <doctest/doctest.h>

#include "emit/target_uses.hpp"
#include "emit/targets.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

std::string modelica_text(const Example& e) {
  const auto files = emit::emit(e.program, e.context, "modelica");
  REQUIRE(files.size() == 1);
  CHECK(files[0].name == emit::modelica_name(e.context.id) + ".mo");
  for (const char letter : files[0].text)
    CHECK((static_cast<unsigned char>(letter) < 0x7f && (letter >= ' ' || letter == '\n')));
  return files[0].text;
}

std::string failure_of_flat_model(const Example& e, const std::string& text) {
  const Folder folder;
  emit::write_files(folder.path, {{emit::modelica_name(e.context.id) + ".mo", text}});
  return target_uses().at("modelica")(folder.path, e);
}

}  // namespace

TEST_CASE("target modelica: the equations are balanced and give the high-precision values") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    CHECK(failure_of_flat_model(e, modelica_text(e)) == "");
  }
}

TEST_CASE("target modelica: parameters, inputs and states have units and values") {
  Example e = example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"});
  e.context.coordinates[0].unit = "m";
  e.context.parameters[2].unit = "kg*m^2/s^2";
  e.context.parameters[3].unit = "m^(1/2)";
  e.context.parameters[3].note = "a root";
  const std::string text = modelica_text(e);
  for (const char* line : {"  parameter Real M(unit = \"kg\") = 0.5;\n", "(unit = \"kg.m2/s2\")",
                           "  parameter Real g = 0.875 \"a root\";\n", "  input Real F(start = 0.25, unit = \"N\");\n",
                           "fixed = true, unit = \"m\");\n", "fixed = true, unit = \"m/s\");\n", "  der(x) = x_dot;",
                           "// Without the functions jac"})
    CHECK_MESSAGE(text.find(line) != std::string::npos, line);
}

TEST_CASE("target modelica: a wrong equation and a missing one are found by the evaluator") {
  if (!runs("python3")) return;
  const Example e = example("eom", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"});
  const std::string text = modelica_text(e);
  REQUIRE(failure_of_flat_model(e, text) == "");
  const std::size_t begin = text.find("  der(theta2_dot) = ");
  REQUIRE(begin != std::string::npos);
  CHECK(failure_of_flat_model(e, text.substr(0, begin) + text.substr(text.find('\n', begin) + 1)) != "");
  std::string wrong = text;
  wrong.replace(begin, 20, "  der(theta2_dot) = 1.0 + ");
  CHECK(failure_of_flat_model(e, wrong) != "");
}

TEST_CASE("target modelica: names of Modelica and hostile texts cause no harm") {
  for (const char* id : {"model", "end", "Real", "der"}) {
    INFO(id);
    auto e = example(id, cart_pendulum(), {"time", "equation"}, {"when", "power", "der", "final", "Real"}, {"input"});
    e.context.title = "\"; end x; model y \" // */ \n equation";
    e.context.parameters[0].note = "\\\" = 3; equation \n";
    e.context.parameters[1].unit = "\\\"; // \xff";
    CHECK(failure_of_flat_model(e, modelica_text(e)) == "");
  }
}

TEST_CASE("target modelica: what a flat model cannot state is refused by name") {
  Example e = examples()[0];
  e.context.events.push_back({"bump", "rising", "record", {}});
  CHECK(modelica_text(e).find("// Without the events bump") != std::string::npos);
  e.context.events[0].reset.set = {{}};
  CHECK_THROWS_WITH_AS(emit::emit(e.program, e.context, "modelica"), doctest::Contains("the reset at the event 'bump'"),
                       Error);
  e.context.events.clear();
  e.context.samples.push_back({"clock", 0.1, 0, {}, {}});
  CHECK_THROWS_WITH_AS(emit::emit(e.program, e.context, "modelica"), doctest::Contains("the sample 'clock'"), Error);
  e.context.samples.clear();
  e.context.jumps_in_time = true;
  CHECK_THROWS_WITH_AS(emit::emit(e.program, e.context, "modelica"), doctest::Contains("the jump of velocities"),
                       Error);
  e.context.jumps_in_time = false;
  e.program.contacts.push_back({{}, "floor"});
  CHECK_THROWS_WITH_AS(emit::emit(e.program, e.context, "modelica"), doctest::Contains("the contact 'floor'"), Error);
}
