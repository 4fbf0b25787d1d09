// SPDX-License-Identifier: GPL-3.0-or-later
// Imported robots as programs, and robots of the tests as tables of joints.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "import/import.hpp"
#include "import/recursion.hpp"
#include "model/model.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::test {

// Two evaluations in binary64 of mass matrices with conditions of some hundreds.
inline constexpr double rounding = 1e-12;
inline constexpr double g = 9.81;
inline constexpr int states = 20;

/// A tree of joints of every kind with one coordinate: rpy in general position, full tensors, fixed links with mass,
/// axes that are none of x, y, z.
std::vector<RobotJoint> tree();
extern const RobotJoint base;
/// The free base as three prismatic and three revolute joints, the last of which carries it.
std::vector<RobotJoint> floating_tree();

/// The cheapest program of an imported model, interpreted in binary64.
struct Imported {
  explicit Imported(const std::string& file, const import::ImportOptions& options = {});

  /// u: inputs; none: zeros.
  std::vector<double> accelerations(const std::vector<double>& q, const std::vector<double>& qdot,
                                    const std::vector<double>& u = {}) const;

  import::ImportedModel text;
  std::shared_ptr<const model::Model> model;
  std::unique_ptr<pipeline::DerivedModel> derived;
  program::Program program;
};

std::vector<double> random_values(std::mt19937_64& engine, std::size_t n, double bound);
/// Largest difference over random states, relative to the largest acceleration of each.
double difference(const Imported& imported, const std::vector<RobotJoint>& robot, std::size_t n);

}  // namespace eomgen::test
