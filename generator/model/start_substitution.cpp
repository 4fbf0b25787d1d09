// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/start_substitution.hpp"

namespace eomgen::model {
namespace {

struct Unknown {
  std::string why;
};

}  // namespace

NodeId StartSubstitution::operator()(NodeId node) {
  try {
    return replaced(node);
  } catch (const Unknown& unknown) {
    obstacle_ = unknown.why;
    return no_node;
  }
}

NodeId StartSubstitution::push(Node node) {
  model_.arena.nodes.push_back(node);
  return static_cast<NodeId>(model_.arena.nodes.size() - 1);
}

NodeId StartSubstitution::coordinate(const Node& node) {
  const Coordinate& c = model_.coordinates[node.index];
  if (node.order > 0) throw Unknown{"it depends on velocities"};
  for (const InitialValue& given : model_.scenes.front().initial) {
    if (given.coordinate == node.index && given.order == 0) return replaced(given.value);
  }
  if (open_.contains(node.index)) throw Unknown{"the start of '" + c.name + "' follows from other constraints"};
  Node zero;
  zero.span = node.span;
  return push(zero);
}

/// The expression for which a name stands; no_node if the node is not a name.
NodeId StartSubstitution::reference(const Node& node) {
  switch (node.op) {
    case Op::time: return model_.scenes.front().t0;
    case Op::function:
      if (node.order > 0) throw Unknown{"it depends on the rate of a function of time"};
      return model_.functions[node.index].expression;
    case Op::definition: return model_.definitions[node.index].expression;
    case Op::place: return model_.places[node.index].position;
    case Op::axis: return model_.frames[node.index].stages[node.order / 3u].e[node.order % 3u];
    default: return no_node;
  }
}

NodeId StartSubstitution::replaced(NodeId id) {
  if (id == no_node) return id;
  if (const auto found = known_.find(id); found != known_.end()) return found->second;
  Node node = model_.arena[id];
  NodeId result = no_node;
  switch (node.op) {
    case Op::coordinate: result = coordinate(node); break;
    case Op::integral: {  // counts from the start
      Node zero;
      zero.span = node.span;
      result = push(zero);
      break;
    }
    case Op::state: throw Unknown{"it depends on states of first order"};
    case Op::total_derivative:
    case Op::partial_derivative:
    case Op::place_velocity:
    case Op::place_acceleration:
    case Op::angular_velocity:
    case Op::unit_basis:
    case Op::covariant_basis:
    case Op::contravariant_basis:
    case Op::input: throw Unknown{"it is made of derivatives or base vectors"};
    default:
      if (const NodeId stands_for = reference(node); stands_for != no_node) {
        result = replaced(stands_for);
        break;
      }
      bool same = true;
      for (NodeId& arg : node.args) {
        const NodeId old = arg;
        arg = replaced(arg);
        same = same && arg == old;
      }
      result = same ? id : push(node);
  }
  known_[id] = result;
  return result;
}

}  // namespace eomgen::model
