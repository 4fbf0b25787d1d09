// SPDX-License-Identifier: GPL-3.0-or-later
// Imported robots against a Newton-Euler recursion on the same numbers.
#include "import/import.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "import/number.hpp"
#include "import/recursion.hpp"
#include "model/model.hpp"
#include "pipeline/pipeline.hpp"
#include "program/interpret.hpp"

using namespace eomgen;
using import::import_text;
using import::ImportOptions;
using test::RobotJoint;

namespace {

// Two evaluations in binary64 of mass matrices with conditions of some hundreds.
constexpr double rounding = 1e-12;
constexpr double g = 9.81;
constexpr int states = 20;

/// A tree of joints of every kind with one coordinate: rpy in general position, full tensors, fixed links with mass,
/// axes that are none of x, y, z.
std::vector<RobotJoint> tree() {
  return {
      {"revolute",
       -1,
       {0.1, -0.2, 0.3},
       {0.3, -0.5, 1.1},
       {0, 0, 1},
       2,
       {0.05, -0.02, 0.1},
       {0.2, 0.4, -0.3},
       {0.04, 0.003, -0.002, 0.05, 0.004, 0.03},
       0.3},
      {"prismatic",
       0,
       {0, 0.1, 0.2},
       {1.5707963267948966, 0, 0},
       {0, -1, 0},
       1.5,
       {0.02, 0.03, -0.04},
       {},
       {0.02, 0.001, 0, 0.03, -0.002, 0.025},
       2},
      {"fixed",
       1,
       {0.1, 0.05, -0.02},
       {0.1, 0.2, 0.3},
       {1, 0, 0},
       0.4,
       {0.01, 0.02, 0.03},
       {0, 0, 1.5707963267948966},
       {0.002, 0.0001, 0, 0.003, 0, 0.004},
       0},
      {"continuous",
       2,
       {0.05, 0, 0.1},
       {-0.4, 0.7, 0.2},
       {1, 2, -2},
       0.8,
       {0.03, -0.01, 0.06},
       {0.5, 0, 0},
       {0.006, 0.0005, 0.0003, 0.005, -0.0002, 0.004},
       0},
      {"fixed", 3, {0, 0, 0.2}, {0, 1.5707963267948966, 0}, {1, 0, 0}, 0, {}, {}, {}, 0},
      {"revolute", 4, {0.1, 0, 0}, {}, {0, 1, 0}, 0.5, {0, 0.01, 0.05}, {}, {0.001, 0, 0, 0.0012, 0, 0.0008}, 0.05},
      {"revolute",
       0,
       {-0.1, 0.2, 0},
       {0, 0, 3.141592653589793},
       {-1, 0, 0},
       0.9,
       {0, 0.1, -0.05},
       {},
       {0.01, -0.001, 0.002, 0.008, 0.0005, 0.012},
       0.1},
  };
}
const RobotJoint base{
    "fixed", -1, {}, {}, {1, 0, 0}, 5, {0.02, 0.01, -0.03}, {0.1, 0.2, 0.3}, {0.2, 0.01, -0.02, 0.3, 0.015, 0.25}, 0};

/// The free base as three prismatic and three revolute joints, the last of which carries it.
std::vector<RobotJoint> floating_tree() {
  std::vector<RobotJoint> robot;
  for (const auto& [type, axis] : {std::pair<const char*, test::Triple>{"prismatic", {1, 0, 0}},
                                   {"prismatic", {0, 1, 0}},
                                   {"prismatic", {0, 0, 1}},
                                   {"revolute", {0, 0, 1}},
                                   {"revolute", {0, 1, 0}},
                                   {"revolute", {1, 0, 0}}})
    robot.push_back({type, static_cast<int>(robot.size()) - 1, {}, {}, axis, 0, {}, {}, {}, 0});
  RobotJoint& body = robot.back();
  body.mass = base.mass;
  body.centre = base.centre;
  body.inertial_rpy = base.inertial_rpy;
  body.tensor = base.tensor;
  for (RobotJoint joint : tree()) {
    joint.parent += 6;
    robot.push_back(joint);
  }
  return robot;
}

/// The cheapest program of an imported model, interpreted in binary64.
struct Imported {
  explicit Imported(const std::string& urdf, const ImportOptions& options = {})
      : text(import_text("robot.urdf", urdf, options)),
        model(std::make_shared<const model::Model>(model::read_model_text(text.text, "robot.toml"))),
        derived(pipeline::derive_model(model, pipeline::ApproachChoice::automatic)),
        program(pipeline::make_program(*derived, {})) {}

  std::vector<double> accelerations(const std::vector<double>& q, const std::vector<double>& qdot) const {
    std::vector<double> x = q, parameters;
    x.insert(x.end(), qdot.begin(), qdot.end());
    const run::Scene scene =
        run::resolve_scene(derived->mechanics, derived->candidates.front(), model->scene("default"), {});
    program::Arguments<double> arguments{0, x, scene.parameters, std::vector<double>(model->inputs.size(), 0.0)};
    const std::vector<double> dx = program::interpret(program.functions.front(), arguments).results.front();
    return {dx.begin() + static_cast<std::ptrdiff_t>(q.size()), dx.end()};
  }

  import::ImportedModel text;
  std::shared_ptr<const model::Model> model;
  std::unique_ptr<pipeline::DerivedModel> derived;
  program::Program program;
};

std::vector<double> random_values(std::mt19937_64& engine, std::size_t n, double bound) {
  std::vector<double> result(n);
  for (double& x : result) x = std::uniform_real_distribution<>(-bound, bound)(engine);
  return result;
}

/// Largest difference over random states, relative to the largest acceleration of each.
double difference(const Imported& imported, const std::vector<RobotJoint>& robot, std::size_t n) {
  std::mt19937_64 engine(11);
  double largest = 0;
  for (int i = 0; i < states; ++i) {
    // Within the pitch at which 3-2-1 angles fail.
    const std::vector<double> q = random_values(engine, n, 1.2), qdot = random_values(engine, n, 2);
    const std::vector<double> ours = imported.accelerations(q, qdot), expected = test::accelerations(robot, q, qdot, g);
    REQUIRE(ours.size() == n);
    double scale = 0, off = 0;
    for (std::size_t k = 0; k < n; ++k) {
      scale = std::max(scale, std::abs(expected[k]));
      off = std::max(off, std::abs(ours[k] - expected[k]));
    }
    largest = std::max(largest, off / scale);
  }
  return largest;
}

}  // namespace

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
