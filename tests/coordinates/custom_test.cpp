// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates defined by the model, by x(q), by q(x), or by both.
#include <doctest/doctest.h>

#include <fstream>

#include "reading/by_name.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

std::string custom(const std::string& position, const std::string& coordinates = "") {
  return "format = 1\n[parameters]\nm = 1\nk = 0.7\n" + coordinates +
         "[[particle]]\nname = \"P\"\nmass = \"k*m\"\nposition = { " + position + " }\n";
}

std::string refusal(const std::string& text) {
  try {
    model::read_model_text(text, "custom.toml");
  } catch (const Error& error) {
    return error.message();
  }
  return "accepted";
}

struct Solved {
  explicit Solved(const std::string& text) : s(model::read_model_text(text, "custom")) {}
  Sum x(std::size_t c) { return reading::display_sum(s.mechanics, (*s.mechanics.place_position[1])[c]); }
  Sum q(const std::string& name) { return s.symbol(name); }
  System s;
};

const std::string solve_first = "custom = [\"a\", \"b\", \"c\"], ";

}  // namespace

TEST_CASE("q(x) is solved for one unknown after the other, in any order") {
  Solved triangular(custom(solve_first + "q = [\"x1/cos(k)\", \"x2 - x1*tan(k)\", \"x3\"]"));
  const Sum a = triangular.q("a"), b = triangular.q("b"), k = triangular.q("k");
  CHECK(same(triangular.x(0), a * cos(k)));
  CHECK(reading::is_zero(triangular.x(1) - b - a * sin(k)));
  CHECK(triangular.x(2) == triangular.q("c"));
  Solved shifted(custom(solve_first + "q = [\"x3 - k*x1*x2\", \"(x1 + 1)/2\", \"2 - x2/k\"]"));
  const Sum x1 = Sum(2) * shifted.q("b") - Sum(1), x2 = shifted.q("k") * (Sum(2) - shifted.q("c"));
  CHECK(same(shifted.x(0), x1));
  CHECK(same(shifted.x(1), x2));
  CHECK(same(shifted.x(2), shifted.q("a") + shifted.q("k") * x1 * x2));
}

TEST_CASE("q(x) is solved: linear systems") {
  Solved linear(custom(solve_first + "q = [\"x1 + x2 + x3\", \"x1 - x2\", \"x1 + k*x3\"]"));
  const Sum a = linear.q("a"), b = linear.q("b"), c = linear.q("c"), k = linear.q("k");
  const Sum x1 = linear.x(0), x2 = linear.x(1), x3 = linear.x(2);
  CHECK(reading::is_zero(x1 + x2 + x3 - a));
  CHECK(reading::is_zero(x1 - x2 - b));
  CHECK(reading::is_zero(x1 + k * x3 - c));
}

TEST_CASE("q(x) is solved: functions with a unique inverse are inverted") {
  Solved s(custom(solve_first + "q = [\"exp(x1)\", \"sinh(x2 - x1)\", \"x3*x1^2 + atan(k*x2)\"]",
                  "[coordinates]\na = { range = [1, 4] }\n"));
  const auto log = [](const Sum& x) { return reading::call(symbolic::Op::log, {x}); };
  CHECK(reading::is_zero(s.x(0) - log(s.q("a"))));
  CHECK(reading::is_zero(s.x(1) - s.x(0) - log(s.q("b") + sqrt(square(s.q("b")) + Sum(1)))));
  CHECK(refusal(custom(solve_first + "q = [\"sqrt(x1)\", \"x2\", \"x3\"]",
                       "[coordinates]\na = { range = [0, inf] }\n")) == "accepted");
}

TEST_CASE("x(q) and q(x), given together, are checked against each other") {
  const std::string polar = solve_first + "x = [\"a*cos(b)\", \"a*sin(b)\", \"c\"], ";
  const std::string range = "[coordinates]\na = { range = [0, inf] }\n";
  const std::string good = "q = [\"sqrt(x1^2 + x2^2)\", \"atan2(x2, x1)\", \"x3\"]";
  CHECK(refusal(custom(polar + good, range)) == "accepted");
  CHECK(refusal(custom(polar + good)).find("q(x) and x(q) are not inverse") != std::string::npos);
  const std::string bad = refusal(custom(polar + "q = [\"sqrt(x1^2 + x2^2)\", \"atan2(x1, x2)\", \"x3\"]", range));
  CHECK(bad.find("q(x) and x(q) are not inverse: where this coordinate is") != std::string::npos);
}

TEST_CASE("custom coordinates: the examples of docs/model-format.md are read") {
  std::ifstream page(source_folder() + "/docs/model-format.md");
  const std::string begin = "position = { custom";
  int examples = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with(begin)) continue;
    CAPTURE(line);
    const std::size_t inside = line.find('{') + 1;
    const bool polar = line.find("atan2") != std::string::npos;
    CHECK(refusal(custom(line.substr(inside, line.find('}') - inside),
                         polar ? "[coordinates]\nr = { range = [0, inf] }\n" : "")) == "accepted");
    ++examples;
  }
  CHECK(examples == 3);
}

TEST_CASE("invalid coordinate systems are rejected") {
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  // two solutions, no solution by elementary steps, dependent, constant
  for (const char* q :
       {"[\"x1^2\", \"x2\", \"x3\"]", "[\"sin(x1)\", \"x2\", \"x3\"]", "[\"x1 + sin(x1)\", \"x2\", \"x3\"]",
        "[\"x1 + x2\", \"x1 + x2\", \"x3\"]", "[\"x1 - x1\", \"x2\", \"x3\"]", "[\"1\", \"x2\", \"x3\"]"}) {
    CAPTURE(q);
    CHECK(contains(refusal(custom(solve_first + "q = " + q)), "q(x) cannot be solved for x1, x2, x3"));
  }
  CHECK(contains(refusal(custom(solve_first + "q = [\"x1 + k*x2\", \"k*x1 + k^2*x2\", \"x3\"]")), "too few points"));
  CHECK(contains(refusal(custom(solve_first + "q = [\"sqrt(x1)\", \"x2\", \"x3\"]")), "q(x) and x(q) are not inverse"));
  CHECK(contains(refusal(custom(solve_first + "x = [\"a + b\", \"(a + b)*k\", \"c\"]")),
                 "these custom coordinates are singular everywhere"));
  CHECK(
      contains(refusal(custom("custom = [\"a\", \"b\", \"c\"]")), "custom coordinates are named here but not defined"));
  CHECK(contains(refusal(custom("custom = [\"a\", \"b\"], x = [\"a\", \"b\", 0]")), "'custom' has 2 entries"));
  CHECK(contains(refusal(custom(solve_first + "x = [\"a\", \"b\"]")), "'x' has 2 entries"));
  CHECK(contains(refusal(custom(solve_first + "q = [\"x1\", \"x2\", \"x3 - a\"]")), "depends on coordinates"));
  CHECK(contains(refusal(custom("custom = [\"x1\", \"b\", \"c\"], q = [\"2*x1\", \"x2\", \"x3\"]")),
                 "'x1' is a Cartesian coordinate"));
  CHECK(contains(refusal(custom("cartesian = [\"a\", \"b\"], x = [\"a\", \"b\", 0]")),
                 "'x' does not belong to a position in cartesian"));
}

TEST_CASE("custom coordinates may measure from a particle, and may be prescribed by parameters") {
  System s(
      model::read_model_text(custom(solve_first + "x = [\"a\", \"a*b\", \"c\"], from = \"Q\"") +
                                 "[[particle]]\nname = \"Q\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\", 0] }\n",
                             "relative"));
  const auto position = *s.mechanics.place_position[1];
  CHECK(reading::display_sum(s.mechanics, position[1]) == s.symbol("a") * s.symbol("b") + s.symbol("y"));
  System fixed(model::read_model_text(custom("custom = [\"k\", \"b\", \"c\"], x = [\"k*cos(b)\", \"k*sin(b)\", \"c\"]"),
                                      "fixed"));
  CHECK(fixed.model.coordinates.size() == 2);
}
