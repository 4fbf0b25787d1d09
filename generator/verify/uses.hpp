// SPDX-License-Identifier: GPL-3.0-or-later
// Whether an expression of a Model contains a node, also through definitions and places.
#pragma once

#include <functional>

#include "model/model.hpp"

namespace eomgen::verify {

bool uses(const model::Model& model, model::NodeId expression, const std::function<bool(const model::Node&)>& is_it);
inline bool uses(const model::Model& model, model::NodeId expression, model::Op op) {
  return uses(model, expression, [op](const model::Node& node) { return node.op == op; });
}

}  // namespace eomgen::verify
