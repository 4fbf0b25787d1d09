// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluation of expressions at the start of the default scene: coordinates are replaced by the initial values of the
// scene (default 0) and t by the start of the run. The result depends on parameters only.
#pragma once

#include <map>
#include <set>
#include <string>

#include "model/model.hpp"

namespace eomgen::model {

class StartSubstitution {
 public:
  /// Adds nodes to the arena of the model, whose scenes must have been read. `open` coordinates have no default of 0:
  /// other conditions determine them.
  StartSubstitution(Model& model, std::set<std::uint32_t> open) : model_(model), open_(std::move(open)) {}

  /// The vector or scalar at the start; no_node if it cannot be determined. obstacle() then contains the reason.
  NodeId operator()(NodeId node);
  const std::string& obstacle() const { return obstacle_; }

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
