// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions as they are at the start of the default scene: coordinates are replaced by what the scene gives (0 where
// it gives nothing), t by the start of the run. What is left is made of parameters.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "model/model.hpp"

namespace eomgen::model {

class AtStart {
 public:
  /// Adds nodes to the arena of the model, whose scenes have been read. `open` coordinates are not 0 where the scene
  /// gives nothing: something else tells them.
  AtStart(Model& model, std::set<std::uint32_t> open) : model_(model), open_(std::move(open)) {}

  /// The same vector or scalar at the start; no_node where that cannot be told, and then `obstacle` says why.
  NodeId operator()(NodeId node);
  const std::string& obstacle() const { return obstacle_; }

  /// Components along E1, E2, E3 of such a vector, the value of such a scalar, with the parameters as the file gives
  /// them.
  std::array<double, 3> vector_value(NodeId at_start);
  double scalar_value(NodeId at_start);

 private:
  NodeId replaced(NodeId id);
  NodeId reference(const Node& node);
  NodeId coordinate(const Node& node);
  NodeId push(Node node);

  Model& model_;
  std::set<std::uint32_t> open_;
  std::map<NodeId, NodeId> known_;
  std::string obstacle_;
};

}  // namespace eomgen::model
