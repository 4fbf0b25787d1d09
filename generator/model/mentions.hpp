// SPDX-License-Identifier: GPL-3.0-or-later
// Search for the use of a name in a model's expressions. In: a Model, a test of nodes. Out: a sentence about the first
// use.
#pragma once

#include <functional>
#include <string>

#include "model/model.hpp"

namespace eomgen::model {

/// An expression on which the motion depends or that can be an output, and the object to which it belongs.
struct ModelExpression {
  NodeId expression = no_node;
  std::string of;           // "constraint 'level'"
  std::uint32_t frame = 0;  // of a rotation: index of its frame; else 0
  std::uint32_t place = 0;  // of a position: index of its place; else 0
};

/// All expressions of a model except those of scenes, which refer to the start only.
std::vector<ModelExpression> model_expressions(const Model& model);

/// "WHAT is named by OF" for the first node for which `what` returns a text; empty if there is none.
std::string find_mention(const Model& model,
                         const std::function<std::string(const Node& node, const ModelExpression& root)>& what);

}  // namespace eomgen::model
