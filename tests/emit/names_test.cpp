// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/names.hpp"

#include <doctest/doctest.h>

#include "emit/context.hpp"

using namespace eomgen::emit;

TEST_CASE("names: reserved names of languages and headers get a trailing underscore") {
  NameTable names;
  CHECK(names.declare("theta") == "theta");
  CHECK(names.declare("int") == "int_");
  CHECK(names.declare("I") == "I_");
  CHECK(names.declare("M_PI") == "M_PI_");
  CHECK(names.declare("M_12") == "M_12");
  CHECK(names.declare("v1") == "v1_");
  CHECK(names.declare("v") == "v");
  CHECK(names.declare("gamma") == "gamma");
}

TEST_CASE("names: two requests for one name give two names") {
  NameTable names;
  CHECK(names.declare("x") == "x");
  CHECK(names.declare("x") == "x_");
  CHECK(names.declare("x_") == "x__");
  CHECK(names.declare("P.position1") == "P_position1");
}

TEST_CASE("names: a model's id becomes an identifier") {
  CHECK(mangled_id("p7_moving_sphere") == "p7_moving_sphere");
  CHECK(mangled_id("7") == "model_7");
  CHECK(mangled_id("a-b c") == "a_b_c");
  CHECK(mangled_id("class") == "class_");
  CHECK(mangled_id("") == "model_");
}

TEST_CASE("names: a name that begins like a reserved one becomes a legal name at once") {
  for (const char* wanted : {"\"\"\"", "__x", "_X", "___"}) {
    eomgen::emit::NameTable table;
    const std::string name = table.declare(wanted);
    CHECK_FALSE(eomgen::emit::is_reserved(name));
    CHECK(name[0] != '_');
  }
}

TEST_CASE("names: a model named like a part of Python gets another module name and keeps its C names") {
  for (const char* id : {"json", "numpy", "lambda", "None", "ctypes", "math", "test"}) {
    CAPTURE(id);
    CHECK(module_name(id) == mangled_id(id) + "_");
  }
  CHECK(mangled_id("json") == "json");
  CHECK(module_name("cart_pendulum") == "cart_pendulum");
  CHECK(module_name("int") == "int_");
}
