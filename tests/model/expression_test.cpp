// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>

#include "model_support.hpp"

using namespace eomgen::model;

TEST_CASE("the unary minus binds weaker than the power") {
  CHECK(value_of("-3^2") == -9);
  CHECK(value_of("(-3)^2") == 9);
  CHECK(value_of("2^-1") == ratio(1, 2));
  CHECK(value_of("2^-1+3") == ratio(7, 2));
  CHECK(value_of("2^+2") == 4);
  CHECK(value_of("--3") == 3);
  CHECK(value_of("2*-3") == -6);
}

TEST_CASE("the power associates to the right, the other operators to the left") {
  CHECK(value_of("2^3^2") == 512);
  CHECK(value_of("(2^3)^2") == 64);
  CHECK(value_of("10-4-3") == 3);
  CHECK(value_of("48/4/3") == 4);
  CHECK(value_of("48/4*3") == 36);
  CHECK(value_of("2-3+4") == 3);
  CHECK(value_of("2+3*4^2") == 50);
  CHECK(value_of("-2*3+1") == -5);
}

TEST_CASE("decimals are exact rationals") {
  CHECK(value_of("9.81") == ratio(981, 100));
  CHECK(value_of("0.1+0.2") == ratio(3, 10));
  CHECK(value_of("1.5e3") == 1500);
  CHECK(value_of("25E-2") == ratio(1, 4));
  CHECK(value_of("007") == 7);
  CHECK(value_of("1e+2") == 100);
}

TEST_CASE("TOML numbers are parsed exactly from their text") {
  const Model model = with_parameters("a = 9.81\nb = 1_000.5e-3\nc = -0.3\nd = 1_000\ne1 = +2.5\nf = 0x10");
  CHECK(exact(model, model.parameters[0].value) == ratio(981, 100));
  CHECK(exact(model, model.parameters[1].value) == ratio(10005, 10000));
  CHECK(exact(model, model.parameters[2].value) == ratio(-3, 10));
  CHECK(exact(model, model.parameters[3].value) == 1000);
  CHECK(exact(model, model.parameters[4].value) == ratio(5, 2));
  CHECK(exact(model, model.parameters[5].value) == 16);
}

TEST_CASE("long sums and products keep their value and have small depth") {
  std::string sum = "1000", product = "1";
  for (int k = 1; k <= 500; ++k) sum += (k % 3 == 0 ? "+" : "-") + std::to_string(k);
  for (int k = 1; k <= 300; ++k) product += k % 2 == 0 ? "*2" : "/2";
  long expected = 1000;
  for (int k = 1; k <= 500; ++k) expected += k % 3 == 0 ? k : -k;
  CHECK(value_of(sum) == expected);
  CHECK(value_of(product) == 1);
  const Model model = with_parameters("p = \"" + sum + "\"");
  std::vector<int> depth(model.arena.nodes.size(), 1);
  for (std::size_t k = 0; k < depth.size(); ++k) {
    for (const NodeId child : model.arena.nodes[k].args) {
      if (child == no_node) continue;
      REQUIRE(child < k);  // children before parents
      depth[k] = std::max(depth[k], depth[child] + 1);
    }
  }
  CHECK(*std::max_element(depth.begin(), depth.end()) < 64);
}

TEST_CASE("a nesting depth of 200 is accepted, of 300 is rejected") {
  const auto nested = [](std::size_t n) { return std::string(n, '(') + "1" + std::string(n, ')'); };
  CHECK(value_of(nested(200)) == 1);
  CHECK(refusal(particle("[definitions]\nd = \"" + nested(300) + "\"")) ==
        "the expression is nested more than 256 deep");
}

TEST_CASE("blanks and line breaks have no effect inside an expression") {
  CHECK(value_of(" 1 +\\n 2 *\\t3 ") == 7);
  const Model model = with_parameters("p = \"\"\"\n  1\n  + 2\n\"\"\"");
  CHECK(exact(model, model.parameters[0].value) == 3);
}

TEST_CASE("spans refer to the bytes of the file, also after escapes and in texts of several lines") {
  const Model model = with_parameters("p = \"\\u0031 + 22\"\nq = '''\n  3 +\n  44'''");
  const auto second = [&](std::size_t k) { return model.arena[model.arena[model.parameters[k].value].args[1]].span; };
  CHECK(second(0).line == 3);
  CHECK(second(0).column == 15);
  CHECK(second(0).length == 2);
  CHECK(second(1).line == 6);
  CHECK(second(1).column == 3);
}

TEST_CASE("a comparison in if() is stored in one of two forms") {
  const Model model =
      read(particle("[definitions]\na = \"if(R < L, 1, 2)\"\nb = \"if(R <= L, 1, 2)\"\n"
                    "c = \"if(R > L, 1, 2)\"\nd = \"if(R >= L, 1, 2)\"\n"));
  const auto shape = [&](std::size_t k) {
    const Node& node = model.arena[model.definitions[k].expression];
    REQUIRE(node.op == Op::conditional);
    const bool swapped_sides = model.arena[node.args[0]].op == Op::parameter;
    const bool swapped_values = model.arena[node.args[2]].value == 2;
    return std::pair(swapped_sides, swapped_values);
  };
  CHECK(shape(0) == std::pair(false, false));  // R < L ? 1 : 2
  CHECK(shape(1) == std::pair(true, true));    // L < R ? 2 : 1
  CHECK(shape(2) == std::pair(true, false));   // L < R ? 1 : 2
  CHECK(shape(3) == std::pair(false, true));   // R < L ? 2 : 1
}

TEST_CASE("min and max of several arguments become nested pairs") {
  const Model model = read(particle("[definitions]\na = \"max(1, 2, 3)\"\n"));
  const Node& outer = model.arena[model.definitions[0].expression];
  CHECK(outer.fn == Fn::max);
  CHECK(model.arena[outer.args[0]].fn == Fn::max);
  CHECK(model.arena[outer.args[1]].value == 3);
}

TEST_CASE("operands determine whether an expression is a scalar or a vector") {
  const Model model =
      read(particle("[definitions]\na = \"cross(P, velocity(P))\"\nb = \"dot(P, E3)\"\n"
                    "c = \"norm(P)*unit(P)\"\nd = [0, 1, \"R/L\"]\ne = \"0*E1 + 0\"\n"));
  CHECK(model.definitions[0].vector);
  CHECK(!model.definitions[1].vector);
  CHECK(model.definitions[2].vector);
  CHECK(model.definitions[3].vector);
  CHECK(model.definitions[4].vector);
  CHECK(model.definitions[0].unit.text == "m^2/s");
  CHECK(model.definitions[1].unit.text == "m");
}

TEST_CASE("velocities and accelerations have names, and derivatives have two forms") {
  const Model model =
      read(particle("[functions]\nd = \"L + t*L/2[s]\"\n[definitions]\na = \"theta_dot\"\nb = \"theta_ddot\"\n"
                    "c = \"d_dot*2[s] + d\"\ne = \"ddt(R*phi)\"\nf = \"diff(R^2*phi_dot, phi_dot)\"\n"));
  const auto node = [&](std::size_t k) { return model.arena[model.definitions[k].expression]; };
  CHECK(node(0).order == 1);
  CHECK(node(1).order == 2);
  CHECK(model.definitions[1].unit.text == "1/s^2");
  CHECK(node(3).op == Op::total_derivative);
  CHECK(model.definitions[3].unit.text == "m/s");
  CHECK(node(4).op == Op::partial_derivative);
  CHECK(model.arena[node(4).args[1]].order == 1);
  CHECK(model.definitions[4].unit.text == "m^2");
}
