// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a model's expressions at made-up points, in double: enough to tell that coordinates are dependent or that
// two formulas are not inverse. In: nodes of the arena. Out: numbers; NaN for what has none or is not of scalars.
#pragma once

#include <map>
#include <vector>

#include "model/model.hpp"

namespace eomgen::model {

/// f(x) in binary64, f(x, y) of functions of two arguments.
double value_of(Fn fn, double x, double y);

class Samples {
 public:
  explicit Samples(const Model& model) : model_(model) {}

  /// Another point: every coordinate within its range (between -1.5 and 1.5 where there is none); the same sequence in
  /// every process.
  void next();
  double value(NodeId node);
  double coordinate(std::uint32_t index) const { return q_[index]; }
  /// The value with one coordinate moved.
  double moved(NodeId node, std::uint32_t coordinate, double by);

  /// det(a_i . a_k) of the tangents dx/dq_i at this point, each scaled to unit length: 0 where they are dependent.
  double independence(const std::array<NodeId, 3>& x, const std::vector<std::uint32_t>& coordinates);

 private:
  double fresh(const Node& node);
  double random();

  const Model& model_;
  std::vector<double> q_;
  std::map<NodeId, double> known_;  // at this point
  std::uint64_t state_ = 20041;
};

}  // namespace eomgen::model
