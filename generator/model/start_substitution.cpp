// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/start_substitution.hpp"

#include <cln/rational.h>

#include <cmath>
#include <limits>

#include "model/samples.hpp"

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

double StartSubstitution::scalar_value(NodeId id) {
  const Node& node = model_.arena[id];
  const auto arg = [&](std::size_t k) { return scalar_value(node.args[k]); };
  switch (node.op) {
    case Op::dot:
    case Op::norm: {
      const auto a = vector_value(node.args[0]), b = vector_value(node.args[node.op == Op::dot ? 1 : 0]);
      const double sum = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      return node.op == Op::dot ? sum : std::sqrt(sum);
    }
    case Op::add: return arg(0) + arg(1);
    case Op::subtract: return arg(0) - arg(1);
    case Op::negate: return -arg(0);
    case Op::multiply: return arg(0) * arg(1);
    case Op::divide: return arg(0) / arg(1);
    case Op::power: return std::pow(arg(0), arg(1));
    case Op::call: return value_of(node.fn, arg(0), node.args[1] == no_node ? 0 : arg(1));
    case Op::conditional: return arg(0) < arg(1) ? arg(2) : arg(3);
    default: return Samples(model_).value(id);  // of parameters
  }
}

std::array<double, 3> StartSubstitution::vector_value(NodeId id) {
  const Node& node = model_.arena[id];
  using V = std::array<double, 3>;
  const auto part = [&](std::size_t k) { return vector_value(node.args[k]); };
  const auto times = [](double f, V v) { return V{f * v[0], f * v[1], f * v[2]}; };
  const auto sum = [](const V& a, const V& b, double sign) {
    return V{a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2]};
  };
  const auto is_vector = [&](std::size_t k) { return model_.arena[node.args[k]].vector; };
  switch (node.op) {
    case Op::zero_vector: return {0, 0, 0};
    case Op::fixed_basis:
      return {node.index == 0 ? 1.0 : 0.0, node.index == 1 ? 1.0 : 0.0, node.index == 2 ? 1.0 : 0.0};
    case Op::array: return {scalar_value(node.args[0]), scalar_value(node.args[1]), scalar_value(node.args[2])};
    case Op::add: return sum(part(0), part(1), 1);
    case Op::subtract: return sum(part(0), part(1), -1);
    case Op::negate: return times(-1, part(0));
    case Op::multiply:
      return is_vector(0) ? times(scalar_value(node.args[1]), part(0)) : times(scalar_value(node.args[0]), part(1));
    case Op::divide: return times(1 / scalar_value(node.args[1]), part(0));
    case Op::unit: {
      const V v = part(0);
      return times(1 / std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), v);
    }
    case Op::cross: {
      const V a = part(0), b = part(1);
      return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    case Op::conditional: return scalar_value(node.args[0]) < scalar_value(node.args[1]) ? part(2) : part(3);
    default: break;
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {none, none, none};
}

}  // namespace eomgen::model
