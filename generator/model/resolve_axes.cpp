// SPDX-License-Identifier: GPL-3.0-or-later
// Axes and angular velocities of bodies and frames: nodes for B.e1, B.e1', omega(B).
#include "model/resolver.hpp"
#include "rotations/rotation.hpp"

namespace eomgen::model {

TypedNode Resolver::axis(std::uint32_t frame, std::size_t stage, std::size_t axis, Span span) {
  TypedNode result = make(frame == 0 ? Op::fixed_basis : Op::axis, true, {}, span);
  Node& node = model_.arena.nodes[result.node];
  node.index = frame == 0 ? static_cast<std::uint32_t>(axis) : frame;
  node.order = frame == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(3 * stage + axis);
  result.literal = result.is_pure_number = true;
  if (frame == 0) return result;
  const Symbol& axes = scope_.axes(frame);  // its own stages may be used while it is being read
  result.dependencies = axes.typed.dependencies;
  result.depth = axes.typed.depth + 1;
  return result;
}

TypedNode Resolver::own_axis(std::uint32_t frame, std::size_t axis, Span span) {
  if (frame > 0) symbol(scope_.axes(frame), span);
  return this->axis(frame, frame == 0 ? 0 : model_.frames[frame].stages.size() - 1, axis, span);
}

TypedNode Resolver::dual_vector(std::uint32_t frame, std::size_t entry, Span span) {
  const rotations::Rotation& rotation = *rotations::find(model_.frames[frame].rotation);
  std::map<std::string, TypedNode> local;
  for (std::size_t k = 0; k < rotation.entries.size(); ++k)
    local[rotation.entries[k].name] = coordinate(model_.arena[model_.frames[frame].entries[k]].index, 0, span);
  const Context context{"a dual vector", on_anything, Shape::scalar, std::nullopt, ""};
  std::optional<TypedNode> sum;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string& component = rotation.dual[entry][k];
    if (component == "0") continue;
    const TypedNode axis = own_axis(frame, k, span);
    const TypedNode term = component == "1" ? axis : product_of(text(component, local, span, context), axis, span);
    sum = sum ? sum_of(*sum, term, span) : term;
  }
  return *sum;
}

TypedNode Resolver::angular_velocity(std::uint32_t frame, Span span) {
  const TypedNode axes = frame > 0 ? symbol(scope_.axes(frame), span) : TypedNode{};
  TypedNode result = make(Op::angular_velocity, true, {}, span);
  model_.arena.nodes[result.node].index = frame;
  result.dependencies = axes.dependencies;
  if (axes.dependencies & on_coordinate) result.dependencies |= on_velocity;
  result.depth = axes.depth + 2;
  result.dimension = dimension_of("rad/s");
  return result;
}

TypedNode Resolver::in_axes(const TypedNode& vector, std::uint32_t frame) {
  TypedNode none;
  const Node node = model_.arena[vector.node];
  const auto part = [&](std::size_t k) {
    TypedNode typed;
    typed.node = node.args[k];
    typed.vector = model_.arena[typed.node].vector;
    return typed;
  };
  switch (node.op) {
    case Op::axis:
      if (node.index != frame || node.order / 3u + 1 != model_.frames[frame].stages.size()) return none;
      return axis(0, 0, node.order % 3, node.span);
    case Op::add:
    case Op::subtract:
    case Op::cross: {
      const TypedNode a = in_axes(part(0), frame), b = in_axes(part(1), frame);
      return a.node == no_node || b.node == no_node ? none : make(node.op, true, {a, b}, node.span);
    }
    case Op::negate:
    case Op::unit: {
      const TypedNode a = in_axes(part(0), frame);
      return a.node == no_node ? none : make(node.op, true, {a}, node.span);
    }
    case Op::multiply:
    case Op::divide: {
      const std::size_t v = part(0).vector ? 0 : 1;
      const TypedNode factor = part(1 - v), a = in_axes(part(v), frame);
      if (a.node == no_node || !coordinates_in(factor.node).empty()) return none;
      return v == 0 ? make(node.op, true, {a, factor}, node.span) : make(node.op, true, {factor, a}, node.span);
    }
    default: return none;
  }
}

TypedNode Resolver::unit_of_vector(const TypedNode& vector, Span span) {
  TypedNode result = make(Op::unit, true, {vector}, span);
  result.literal = result.is_pure_number = true;
  return result;
}

TypedNode Resolver::rate(const TypedNode& scalar, Span span) {
  const Node& node = model_.arena.nodes[scalar.node];
  if (node.op == Op::coordinate && node.order == 0) return coordinate(node.index, 1, span);
  TypedNode result = make(Op::total_derivative, false, {scalar}, span);
  if (scalar.dependencies & on_coordinate) result.dependencies |= on_velocity;
  if (scalar.dimension) result.dimension = quotient(*scalar.dimension, dimension_of("s"));
  return result;
}

}  // namespace eomgen::model
