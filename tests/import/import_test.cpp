// SPDX-License-Identifier: GPL-3.0-or-later
// Imported robots against a Newton-Euler recursion on the same numbers.
#include <doctest/doctest.h>

#include "import/imported.hpp"
#include "import/number.hpp"

using namespace eomgen;
using import::ImportOptions;
using test::base;
using test::difference;
using test::floating_tree;
using test::g;
using test::Imported;
using test::random_values;
using test::RobotJoint;
using test::rounding;
using test::states;
using test::tree;

TEST_CASE("import: a tree of every kind of joint has the accelerations of the Newton-Euler recursion") {
  const Imported imported(test::urdf_of(tree(), base));
  CHECK(imported.text.coordinates == std::vector<std::string>{"j0", "j1", "j3", "j5", "j6"});
  CHECK(difference(imported, tree(), 5) < rounding);
}

TEST_CASE("import: parameters in place of numbers, and exact angles, change no acceleration") {
  ImportOptions options;
  options.parameters = true;
  options.exact_angles = true;
  CHECK(difference(Imported(test::urdf_of(tree(), base), options), tree(), 5) < rounding);
}

TEST_CASE("import: a floating base has the accelerations of a chain of three prismatic and three revolute joints") {
  ImportOptions options;
  options.floating = true;
  const Imported imported(test::urdf_of(tree(), base), options);
  CHECK(imported.text.coordinates.front() == "base_x");
  CHECK(difference(imported, floating_tree(), 11) < rounding);
}

TEST_CASE("import: a wrong sign in a tensor is seen by the recursion") {
  std::vector<RobotJoint> other = tree();
  other[0].tensor[1] = -other[0].tensor[1];
  CHECK(difference(Imported(test::urdf_of(tree(), base)), other, 5) > 1e-6);
}

TEST_CASE("import: a joint that mimics another has the accelerations of the reduced equations") {
  std::string urdf = test::urdf_of(tree(), base);
  const std::string at = "<joint name=\"j6\" type=\"revolute\">\n";
  urdf.insert(urdf.find(at) + at.size(), "    <mimic joint=\"j0\" multiplier=\"-2\" offset=\"0.1\"/>\n");
  const Imported imported(urdf);
  REQUIRE(imported.text.constraints == 1);
  std::mt19937_64 engine(5);
  for (int i = 0; i < states; ++i) {
    std::vector<double> q = random_values(engine, 4, 1.2), qdot = random_values(engine, 4, 2);
    q.push_back(0.1 - 2 * q[0]);
    qdot.push_back(-2 * qdot[0]);
    const std::vector<double> ours = imported.accelerations(q, qdot);
    REQUIRE(ours.size() == 5);
    // G^T M G with qdot = G qdot_free: column and row of j6 are added to those of j0.
    auto rows = test::equations_of(tree(), q, qdot, g);
    for (auto& row : rows) row[0] -= 2 * row[4];
    for (std::size_t k = 0; k <= 5; ++k) rows[0][k] -= 2 * rows[4][k];
    rows.pop_back();
    for (auto& row : rows) row.erase(row.begin() + 4);
    std::vector<double> expected = test::solve(rows);
    expected.push_back(-2 * expected[0]);
    for (std::size_t k = 0; k < 5; ++k) CHECK(ours[k] == doctest::Approx(expected[k]).epsilon(rounding).scale(100));
  }
}

TEST_CASE("import: numbers keep their digits, and multiples of pi are found in five digits and more") {
  CHECK(import::to_text(*import::parse_number("+.50")) == "0.50");
  CHECK(import::to_text(*import::parse_number("-1.E-3")) == "-1e-3");
  CHECK(import::to_text(*import::parse_number("-0.0")) == "0");
  for (const char* wrong : {"", "-", ".", "1e", "0x10", "inf", "nan", "1,5", "1 2", "1e400", "1e-400", "${pi}"}) {
    CAPTURE(wrong);
    CHECK_FALSE(import::parse_number(wrong));
  }
  const auto multiple = [](const char* text) {
    const auto found = import::multiple_of_pi(*import::parse_number(text));
    return found ? found->text : std::string();
  };
  CHECK(multiple("1.5708") == "pi/2");
  CHECK(multiple("-3.14159265359") == "-pi");
  CHECK(multiple("2.617993") == "5*pi/6");  // truncated
  CHECK(multiple("-4.71238898038") == "-3*pi/2");
  CHECK(multiple("1.57").empty());
  CHECK(multiple("1.5709").empty());
}
