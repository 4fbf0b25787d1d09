// SPDX-License-Identifier: GPL-3.0-or-later
// Where a model's expressions name something. In: a Model, a test of nodes. Out: a sentence about the first place.
#pragma once

#include <functional>
#include <string>

#include "model/model.hpp"

namespace eomgen::model {

/// An expression that the motion depends on, or that can be an output, and whose it is.
struct Root {
  NodeId expression = no_node;
  std::string of;           // "constraint 'level'"
  std::uint32_t frame = 0;  // of a rotation: whose; else 0
  std::uint32_t place = 0;  // of a position
};

/// All of a model's expressions but those of scenes, which speak of its start.
std::vector<Root> roots(const Model& model);

/// "WHAT is named by OF" of the first node for which `what` is not empty; empty where there is none.
std::string mention(const Model& model, const std::function<std::string(const Node& node, const Root& root)>& what);

}  // namespace eomgen::model
