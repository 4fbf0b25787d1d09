// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/lone_parameter.hpp"

namespace eomgen::model {

std::optional<std::uint32_t> lone_parameter(const Model& model, NodeId expression) {
  std::optional<std::uint32_t> found;
  while (expression != no_node) {
    const Node& node = model.arena[expression];
    if (node.op == Op::parameter) {
      found = node.index;
      expression = model.parameters[node.index].value;
    } else if (node.op == Op::definition) {
      expression = model.definitions[node.index].expression;
    } else {
      break;
    }
  }
  return found;
}

std::optional<std::uint32_t> parameter_along_axis(const Model& model, NodeId expression) {
  const auto is_axis = [&](NodeId id) { return model.arena[id].op == Op::fixed_basis; };
  while (expression != no_node) {
    const Node& node = model.arena[expression];
    if (node.op == Op::negate) {
      expression = node.args[0];
    } else if (node.op == Op::multiply && is_axis(node.args[1])) {
      expression = node.args[0];
    } else if (node.op == Op::multiply && is_axis(node.args[0])) {
      expression = node.args[1];
    } else {
      break;
    }
  }
  return lone_parameter(model, expression);
}

Span origin_of(const Model& model, NodeId expression, const Span& span) {
  const std::optional<std::uint32_t> parameter = lone_parameter(model, expression);
  return parameter ? model.parameters[*parameter].span : span;
}

}  // namespace eomgen::model
