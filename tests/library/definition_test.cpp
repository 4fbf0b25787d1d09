// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "library/example_definitions.hpp"

using namespace eomgen;

TEST_CASE("library: values are valid TOML with escaped strings") {
  CHECK(Value("a").toml() == "\"a\"");
  CHECK(Value(0.1).toml() == "0.1");
  CHECK(Value(3).toml() == "3");
  CHECK(Value(true).toml() == "true");
  CHECK(Value("\"]\n[scene.default]\\").toml() == "\"\\\"]\\u000a[scene.default]\\\\\"");
  CHECK(Value::list({"x", 1, Value::list({2})}).toml() == "[\"x\", 1, [2]]");
  CHECK(Value::table({{"a b", 1}, {"c", "d"}}).toml() == "{ \"a b\" = 1, c = \"d\" }");
}

TEST_CASE("library: a definition gives the equivalent model file") {
  const std::string text = test::pendulum().text();
  const Model made = Model::from(test::pendulum(), "pendulum"), read = Model::from_text(text, "pendulum");
  CHECK(made.id() == "pendulum");
  CHECK(made.title() == "Spherical pendulum");
  CHECK(made.coordinates() == std::vector<std::string>{"r", "phi", "theta"});
  CHECK(made.parameters() == std::vector<std::string>{"m", "L", "g"});
  CHECK(made.scenes() == std::vector<std::string>{"default"});
  CHECK(made.equations().text() == read.equations().text());
}

TEST_CASE("library: errors of a definition have line, column and remedy in its text") {
  Definition d = test::pendulum();
  d.add("constraint", {{"name", "wall"}, {"holonomic", "r - widht"}});
  try {
    Model::from(d, "pendulum");
    FAIL("accepted");
  } catch (const Error& error) {
    CHECK(error.where().file == "pendulum.toml");
    CHECK(error.where().text == "holonomic = \"r - widht\"");
    CHECK(error.where().column == 18);
    CHECK(error.message().find("widht") != std::string::npos);
    CHECK(error.exit_code() == 2);
  }
  CHECK_THROWS_AS(Model::from(Definition("empty")), Error);
  Definition injected("x\"\n[coordinates]\ny = {}");
  CHECK(Model::from_text(injected.text() + "[coordinates]\nq = {}\n[energy]\nkinetic = \"q_dot^2/2\"\n").title() ==
        "x\"\n[coordinates]\ny = {}");
}
