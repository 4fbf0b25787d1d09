// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a model's expressions at sample points, in binary64. They detect dependent coordinates and formulas that
// are not inverse. In: nodes of the arena. Out: numbers; NaN for undefined values and for vectors.
#pragma once

#include <map>
#include <vector>

#include "model/model.hpp"

namespace eomgen::model {

/// f(x) in binary64; f(x, y) for functions of two arguments.
double value_of(Fn fn, double x, double y);

class Samples {
 public:
  /// Before the first point, expressions of parameters have values and those of coordinates are NaN.
  explicit Samples(const Model& model) : model_(model) {}

  /// Moves to the next point: every coordinate within its range (default -1.5 to 1.5). The sequence is the same in
  /// every process.
  void next();
  double value(NodeId node);
  /// Components along E1, E2, E3. NaN for velocities, and for contravariant basis vectors.
  std::array<double, 3> vector(NodeId node);
  double coordinate(std::uint32_t index) const { return q_[index]; }
  /// The value with one coordinate changed by `by`.
  double value_at_offset(NodeId node, std::uint32_t coordinate, double by);

  /// The Gram determinant det(a_i . a_k) of the unit tangents along dx/dq_i at this point; 0 if they are dependent.
  double gram_determinant(const std::array<NodeId, 3>& x, const std::vector<std::uint32_t>& coordinates);

 private:
  double fresh(const Node& node);
  std::array<double, 3> fresh_vector(const Node& node);
  std::array<double, 3> covariant(const Node& node);
  double random();

  const Model& model_;
  std::vector<double> q_;
  std::map<NodeId, double> known_;  // at this point
  std::map<NodeId, std::array<double, 3>> known_vectors_;
  std::uint64_t state_ = 20041;
};

}  // namespace eomgen::model
