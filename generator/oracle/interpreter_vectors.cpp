// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of the oracle's interpreter: places, their velocities and accelerations, and the bases of their coordinates.
#include "oracle/interpreter.hpp"

namespace eomgen::verify {

using model::Node;
using model::NodeId;
using model::Op;

namespace {

Vector map_slope(const Vector& v, unsigned level) {
  return {v[0].slope(level, 0), v[1].slope(level, 0), v[2].slope(level, 0)};
}

}  // namespace

Vector Interpreter::vector(NodeId id) {
  if (id == model::no_node) return {};
  if (const auto found = vectors_.find(id); found != vectors_.end()) return found->second;
  Vector value = read_vector(model_.arena[id]);
  vectors_.emplace(id, value);
  return value;
}

Vector Interpreter::place(std::uint32_t index) { return vector(model_.places[index].position); }

Vector Interpreter::axis(std::uint32_t frame, std::size_t k) {
  if (frame > 0) return vector(model_.frames[frame].stages.back().e[k]);
  Vector e;
  e[k] = Jet(1);
  return e;
}

// The sum of e_k x de_k over the three axes is twice the axial vector of the skew part of dQ Q^T.
Vector Interpreter::axial_vector(std::uint32_t frame, Interpreter& varied, std::size_t direction) {
  Vector sum;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector e = axis(frame, k), moved = varied.axis(frame, k);
    Vector change;
    for (std::size_t c = 0; c < 3; ++c) change[c] = moved[c].slope(varied.level(), direction);
    sum = sum + cross(e, change);
  }
  return (Jet(1) / Jet(2)) * sum;
}

Vector Interpreter::angular_velocity(std::uint32_t frame) { return axial_vector(frame, with_time_slope(), 0); }

Vector Interpreter::virtual_rotation(std::uint32_t frame, std::size_t coordinate) {
  return axial_vector(frame, with_coordinate_slopes(false), coordinate);
}

Vector Interpreter::read_vector(const Node& node) {
  const auto arg = [&](std::size_t i) { return vector(node.args[i]); };
  const auto is_vector = [&](std::size_t i) { return model_.arena[node.args[i]].vector; };
  switch (node.op) {
    case Op::zero_vector: return {};
    case Op::fixed_basis: {
      Vector e;
      e[node.index] = Jet(1);
      return e;
    }
    case Op::array: return {scalar(node.args[0]), scalar(node.args[1]), scalar(node.args[2])};
    case Op::definition: return vector(model_.definitions[node.index].expression);
    case Op::add: return arg(0) + arg(1);
    case Op::subtract: return arg(0) - arg(1);
    case Op::negate: return Vector{} - arg(0);
    case Op::multiply: return is_vector(0) ? scalar(node.args[1]) * arg(0) : scalar(node.args[0]) * arg(1);
    case Op::divide: return (Jet(1) / scalar(node.args[1])) * arg(0);
    case Op::cross: return cross(arg(0), arg(1));
    case Op::unit: return (Jet(1) / norm(arg(0), precision_)) * arg(0);
    case Op::conditional: return arg(less(node) ? 2 : 3);
    case Op::total_derivative: return map_slope(with_time_slope().vector(node.args[0]), with_time_slope().level());
    case Op::partial_derivative: {
      Interpreter& near = by_leaf(model_.arena[node.args[1]]);
      return map_slope(near.vector(node.args[0]), near.level());
    }
    case Op::axis: return vector(model_.frames[node.index].stages[node.order / 3].e[node.order % 3]);
    case Op::angular_velocity: return angular_velocity(node.index);
    case Op::place: return place(node.index);
    case Op::place_velocity: return map_slope(with_time_slope().place(node.index), with_time_slope().level());
    case Op::place_acceleration: {
      Interpreter& later = with_time_slope();
      const Vector twice = map_slope(later.with_time_slope().place(node.index), later.with_time_slope().level());
      return map_slope(twice, later.level());
    }
    default: return read_basis(node);
  }
}

Vector Interpreter::read_basis(const Node& node) {
  const Node* coordinate = node.args[0] == model::no_node ? nullptr : &model_.arena[node.args[0]];
  if (coordinate == nullptr || coordinate->op != Op::coordinate) refuse(node, "not a vector expression");
  switch (node.op) {
    case Op::covariant_basis: return tangent(node.index, *coordinate, false);
    case Op::unit_basis: {
      // relative: a unit vector of the chart keeps its length if the chart's origin moves with the same coordinate
      const Vector a = tangent(node.index, *coordinate, names(node.index, *coordinate));
      return (Jet(1) / norm(a, precision_)) * a;
    }
    case Op::contravariant_basis: return dual(node.index, *coordinate);
    default: refuse(node, "not a vector expression");
  }
}

/// Whether the chart of the place has this coordinate as an entry.
bool Interpreter::names(std::uint32_t index, const Node& coordinate) const {
  const auto& chart = model_.places[index].chart;
  if (!chart) return false;
  for (const NodeId entry : chart->entries) {
    if (entry == model::no_node) continue;
    const Node& slot = model_.arena[entry];
    if (slot.op == Op::coordinate && slot.index == coordinate.index) return true;
  }
  return false;
}

/// a_i = dr/dq_i (1.20); `relative`: r is measured from the origin of the place's chart.
Vector Interpreter::tangent(std::uint32_t index, const Node& coordinate, bool relative) {
  Interpreter& near = by_leaf(coordinate);
  Vector r = near.place(index);
  if (relative) r = r - near.place(model_.places[index].from);
  return map_slope(r, near.level());
}

/// a^i = grad q_i (1.22): a^i . a_k = delta_ik over the coordinates of the place's chart; with fewer than three, within
/// the surface or along the line that they span.
Vector Interpreter::dual(std::uint32_t index, const Node& coordinate) {
  const Vector own = tangent(index, coordinate, false);
  std::vector<Vector> others;
  if (const auto& chart = model_.places[index].chart)
    for (const NodeId entry : chart->entries) {
      if (entry == model::no_node) continue;
      const Node& slot = model_.arena[entry];
      if (slot.op != Op::coordinate || slot.index == coordinate.index) continue;
      others.push_back(tangent(index, slot, false));
    }
  Vector normal = own;
  if (others.size() == 2) {
    normal = cross(others[0], others[1]);
  } else if (others.size() == 1) {
    const Jet along = dot(own, others[0]) / dot(others[0], others[0]);
    normal = own - along * others[0];
  }
  return (Jet(1) / dot(normal, own)) * normal;
}

}  // namespace eomgen::verify
