// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/imported.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "program/interpret.hpp"

namespace eomgen::test {

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

std::vector<RobotJoint> floating_tree() {
  std::vector<RobotJoint> robot;
  for (const auto& [type, axis] : {std::pair<const char*, Triple>{"prismatic", {1, 0, 0}},
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

Imported::Imported(const std::string& file, const import::ImportOptions& options)
    : text(import::import_text("robot.xml", file, options)),
      model(std::make_shared<const model::Model>(model::read_model_text(text.text, "robot.toml"))),
      derived(pipeline::derive_model(model, pipeline::ApproachChoice::automatic)),
      program(pipeline::make_program(*derived, {})) {}

std::vector<double> Imported::accelerations(const std::vector<double>& q, const std::vector<double>& qdot,
                                            const std::vector<double>& u) const {
  std::vector<double> x = q;
  x.insert(x.end(), qdot.begin(), qdot.end());
  const run::Scene scene =
      run::resolve_scene(derived->mechanics, derived->candidates.front(), model->scene("default"), {});
  const std::vector<double> inputs = u.empty() ? std::vector<double>(model->inputs.size(), 0.0) : u;
  program::Arguments<double> arguments{0, x, scene.parameters, inputs};
  const std::vector<double> dx = program::interpret(program.functions.front(), arguments).results.front();
  return {dx.begin() + static_cast<std::ptrdiff_t>(q.size()), dx.end()};
}

std::vector<double> random_values(std::mt19937_64& engine, std::size_t n, double bound) {
  std::vector<double> result(n);
  for (double& x : result) x = std::uniform_real_distribution<>(-bound, bound)(engine);
  return result;
}

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

}  // namespace eomgen::test
