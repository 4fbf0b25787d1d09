// SPDX-License-Identifier: GPL-3.0-or-later
// [[joint]]: two ends, points and axes fixed in each, and the equations of the registry between them.
#include "model/read_joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

namespace {

constexpr const char* joint_form =
    "write type = \"pin\", bodies = [\"A\", \"B\"], at = [\"point of A\", \"point of B\"], axis = [\"A.e3\", "
    "\"B.e3\"]; \"ground\" may be one of the bodies";

std::string joint_types() {
  std::string names;
  for (const joints::Joint& joint : joints::registry()) names += (names.empty() ? "" : ", ") + joint.name;
  return names;
}

double magnitude(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// Directions with a smaller sine of the angle between them count as equal.
constexpr double parallel = 1e-9;

}  // namespace

void JointsReader::declare() {
  for (const Value* table : sections("joint")) {
    check_keys(*table, {"[[joint]]", {"name", "type", "bodies", "at", "axis", "axes"}});
    Joint joint;
    joint.name = text_of_key(*table, "name", "this [[joint]]");
    joint.span = table->find("name")->span;
    joint.constraint = static_cast<std::uint32_t>(model_.constraints.size());
    scope_.declare(SymbolKind::constraint, joint.name, joint.span).index = joint.constraint;
    Constraint constraint;
    constraint.name = joint.name;
    constraint.span = joint.span;
    constraint.joint = static_cast<std::uint32_t>(model_.joints.size());
    model_.constraints.push_back(std::move(constraint));
    model_.joints.push_back(std::move(joint));
  }
}

void JointsReader::read() {
  std::size_t index = 0;
  for (const Value* table : sections("joint")) read_joint(model_.joints[index++], *table);
}

void JointsReader::read_joint(Joint& joint, const Value& table) {
  const std::string what = fmt::format("the joint '{}'", joint.name);
  const Value& type = require_kind(Value::Kind::text, require_value(table, "type", what, joint_form),
                                   fmt::format("'type' of {}", what), joint_form);
  const joints::Joint* kind = joints::find(type.text);
  if (kind == nullptr) {
    std::vector<std::string> names;
    for (const joints::Joint& other : joints::registry()) names.push_back(other.name);
    const std::string hint = did_you_mean(type.text, names);
    source_.fail(type.span, fmt::format("there is no joint of type {}", quote(type.text)),
                 hint.empty() ? "the types are " + joint_types() : hint);
  }
  joint.type = kind->name;
  std::array<JointEnd, 2> ends = joint_ends(table, what);
  for (std::size_t k = 0; k < 2; ++k) joint.frames[k] = ends[k].frame;
  if (const Value* axes = table.find("axes")) joint.axes = require_frame(*axes, fmt::format("'axes' of {}", what));
  joint_points(joint, ends,
               require_value(table, "at", what, "add at = [\"point of A\", \"point of B\"], the points that coincide"),
               what);
  joint_axes(*kind, ends, table, what);

  StartSubstitution start = at_start(joint.constraint);
  const Context any{what, on_anything, Shape::either, std::nullopt, ""};
  const Context vector{what, on_anything, Shape::vector, std::nullopt, ""};
  std::map<std::string, TypedNode> local{{"rA", ends[0].point}, {"rB", ends[1].point}};
  local["d"] = resolver_.text("rB - rA", local, table.span, vector);
  const auto uses = [&](const std::string& name) {
    return std::any_of(kind->equations.begin(), kind->equations.end(),
                       [&](const joints::Equation& e) { return e.psi.find(name) != std::string::npos; });
  };
  if (kind->axes != joints::AxisLayout::none) {
    for (std::size_t k = 0; k < 3; ++k) local[std::array{"a", "a1", "a2"}[k]] = ends[0].axis[k];
    local["b"] = ends[1].axis[0];
  }
  if (uses("b2")) local["b2"] = fixed_in_frame(ends[0].axis[2], ends[1].frame, start, table.span, true);
  for (std::size_t k = 0; k < 3 && uses("f1"); ++k) {
    const TypedNode axis = resolver_.own_axis(ends[0].frame, k, table.span);
    local[fmt::format("f{}", k + 1)] = axis;
    local[fmt::format("g{}", k + 1)] = fixed_in_frame(axis, ends[1].frame, start, table.span, true);
  }
  Constraint& constraint = model_.constraints[joint.constraint];
  for (const joints::Equation& equation : kind->equations) {
    constraint.psi.push_back(resolver_.text(equation.psi, local, joint.span, any).node);
    const auto part = [&](const std::string& text) {
      return text.empty() ? no_node : resolver_.text(text, local, joint.span, vector).node;
    };
    joint.force.push_back(part(equation.force));
    joint.moment.push_back(part(equation.moment));
  }
}

std::array<JointsReader::JointEnd, 2> JointsReader::joint_ends(const Value& table, const std::string& what) {
  const Value& bodies = require_kind(Value::Kind::array, require_value(table, "bodies", what, joint_form),
                                     fmt::format("'bodies' of {}", what), joint_form);
  if (bodies.items.size() != 2) {
    source_.fail(bodies.span, fmt::format("{} is between {} bodies", what, bodies.items.size()),
                 "write bodies = [\"A\", \"B\"]; one of them may be \"ground\"");
  }
  std::array<JointEnd, 2> ends;
  for (std::size_t k = 0; k < 2; ++k) {
    ends[k].frame = require_frame(bodies.items[k], fmt::format("'bodies' of {}", what));
    ends[k].name = bodies.items[k].text;
    if (ends[k].frame > 0 && frame_sources_[ends[k].frame].place == 0) {
      source_.fail(bodies.items[k].span, fmt::format("'{}' is a frame, which has no mass and no place", ends[k].name),
                   "name a [[body]] or \"ground\"");
    }
  }
  if (ends[0].frame == ends[1].frame) {
    source_.fail(
        bodies.span, fmt::format("{} is between '{}' and itself", what, ends[0].name),
        ends[0].frame == 0 ? "one of the two has to be a [[body]]" : "name two bodies, or a body and \"ground\"");
  }
  return ends;
}

// Other constraints determine the initial values of some coordinates: these have no default of 0.
StartSubstitution JointsReader::at_start(std::uint32_t constraint) {
  std::set<std::uint32_t> open;
  const auto add = [&](NodeId node) {
    for (const auto& [index, order] : resolver_.coordinates_in(node)) open.insert(index);
  };
  for (std::uint32_t k = 0; k < model_.constraints.size(); ++k) {
    if (k == constraint) continue;
    for (const NodeId psi : model_.constraints[k].psi) add(psi);
  }
  for (const Value* table : sections("joint")) {
    const Value *bodies = table->find("bodies"), *name = table->find("name");
    if (bodies == nullptr || scope_.find(name->text)->index == constraint) continue;
    for (const Value& body : bodies->items) {
      const Symbol* symbol = scope_.find(body.text);
      if (symbol == nullptr || symbol->frame == 0 || frame_sources_[symbol->frame].place == 0) continue;
      add(resolver_.place(symbol->index, body.span).node);
      for (std::size_t k = 0; k < 3; ++k) add(resolver_.own_axis(symbol->frame, k, body.span).node);
    }
  }
  return StartSubstitution(model_, std::move(open));
}

// A vector fixed in a body that is equal to `direction` at the start.
TypedNode JointsReader::fixed_in_frame(const TypedNode& direction, std::uint32_t frame, StartSubstitution& start,
                                       Span span, bool attitude) {
  const auto known = [&](const TypedNode& typed) {
    TypedNode result = typed;
    result.node = start(typed.node);
    result.dependencies = 0;
    if (result.node == no_node) {
      source_.fail(span, fmt::format("this joint is as placed at the start, and {}", start.obstacle()),
                   attitude ? "give that coordinate in 'initial' of [scene.default]: a slider and a fixed joint keep "
                              "the attitude of one body against the other as it is there"
                            : "give that coordinate in 'initial' of [scene.default], or write two entries, one for "
                              "each body: at = [\"..\", \"..\"], axis = [\"..\", \"..\"]");
    }
    return result;
  };
  std::map<std::string, TypedNode> local{{"v", known(direction)}};
  if (frame == 0) return local["v"];
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    const TypedNode axis = resolver_.own_axis(frame, k, span);
    local[fmt::format("e{}", k + 1)] = axis;
    local[fmt::format("u{}", k + 1)] = known(axis);
    text += fmt::format("{}dot(v, u{})*e{}", k > 0 ? " + " : "", k + 1, k + 1);
  }
  return resolver_.text(text, local, span, {"a direction", on_anything, Shape::vector, std::nullopt, ""});
}

void JointsReader::joint_points(Joint& joint, std::array<JointEnd, 2>& ends, const Value& at, const std::string& what) {
  const Context ground{fmt::format("'at' of {}", what), on_time, Shape::vector, dimension_of("m"),
                       "a point of the ground is made of parameters, functions of time and t"};
  const Context body{ground.what, on_motion, Shape::vector, dimension_of("m"),
                     "a point is made of places, axes of bodies and lengths"};
  if (at.is(Value::Kind::array) && at.items.size() == 2) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t frame = ends[k].frame;
      ends[k].point = resolver_.value(at.items[k], frame == 0 ? ground : body);
      joint.points[k] = ends[k].point.node;
      const Node& node = model_.arena[joint.points[k]];
      if (frame == 0 || (node.op == Op::place && node.index == frame_sources_[frame].place)) continue;
      const std::map<std::string, TypedNode> local{
          {"p", ends[k].point},
          {"r", resolver_.place(frame_sources_[frame].place, at.items[k].span)},
          {"w", resolver_.angular_velocity(frame, at.items[k].span)}};
      joint.drift[k] = resolver_
                           .text("ddt(p - r) - cross(w, p - r)", local, at.items[k].span,
                                 {what, on_anything, Shape::vector, std::nullopt, ""})
                           .node;
    }
    return;
  }
  if (at.is(Value::Kind::array) && at.items.size() != 3) {
    source_.fail(
        at.span, fmt::format("'at' of {} has {} entries", what, at.items.size()),
        "write at = [\"point of A\", \"point of B\"], or at = \"<vector>\" for a point as placed at the start");
  }
  const TypedNode point = resolver_.value(at, body);
  StartSubstitution start = at_start(joint.constraint);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::uint32_t frame = ends[k].frame;
    const TypedNode from = resolver_.place(frame == 0 ? 0 : frame_sources_[frame].place, at.span);
    const Context vector{what, on_anything, Shape::vector, std::nullopt, ""};
    const TypedNode arm = resolver_.text("p - r", {{"p", point}, {"r", from}}, at.span, vector);
    ends[k].point =
        resolver_.text("r + s", {{"r", from}, {"s", fixed_in_frame(arm, frame, start, at.span)}}, at.span, vector);
    joint.points[k] = ends[k].point.node;
  }
}

std::optional<std::size_t> JointsReader::own_axis_of_plane(const TypedNode& vector, std::uint32_t frame) const {
  const Node& node = model_.arena[vector.node];
  if (node.op != Op::fixed_basis) return std::nullopt;
  if (frame == 0) return node.index;
  const FrameDeclaration& of = frame_sources_[frame];
  if (of.has_axes_of_space()) return node.index;
  if (!of.starts_aligned || !of.axis || !of.axis->numbers) return std::nullopt;
  for (std::size_t k = 0; k < 3; ++k) {
    if ((k == node.index) == cln::zerop((*of.axis->numbers)[k])) return std::nullopt;
  }
  return node.index;
}

// The axis of one end and two directions normal to it, with constant components along the axes of that body.
std::array<TypedNode, 3> JointsReader::triad_about(const Value& written, const JointEnd& end, const std::string& what) {
  const std::string of = end.frame == 0 ? "E1, E2, E3" : fmt::format("{0}.e1, {0}.e2, {0}.e3", end.name);
  const Context context{fmt::format("an axis of {}", what), end.frame == 0 ? Dependencies{0} : on_motion, Shape::vector,
                        std::nullopt, "it is fixed in its body: make it of " + of};
  const TypedNode axis = resolver_.value(written, context);
  const bool in_plane = own_axis_of_plane(axis, end.frame).has_value();
  const TypedNode along = end.frame == 0 || in_plane ? axis : resolver_.in_axes(axis, end.frame);
  if (along.node == no_node)
    source_.fail(written.span, fmt::format("this axis is not fixed in '{}'", end.name),
                 "make it of " + of + " with constant components");
  const auto own = [&](std::size_t k) { return resolver_.own_axis(end.frame, k % 3, written.span); };
  if (const Node& node = model_.arena[along.node]; node.op == Op::fixed_basis) {
    const std::size_t k = node.index;
    return {own(k), own(k + 1), own(k + 2)};
  }
  const std::array<double, 3> v = Samples(model_).vector(along.node);
  if (!(magnitude(v) > 0))
    source_.fail(written.span, fmt::format("an axis of {} has no direction", what), "make it of " + of);
  // The first normal direction uses the body axis that is least aligned with the joint axis.
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(v[k]) < std::abs(v[least])) least = k;
  }
  const Context vector{what, on_anything, Shape::vector, std::nullopt, ""};
  std::map<std::string, TypedNode> local{{"v", along}, {"c", resolver_.own_axis(0, least, written.span)}};
  std::array<TypedNode, 3> triad{resolver_.text("unit(v)", local, written.span, vector),
                                 resolver_.text("unit(cross(v, c))", local, written.span, vector),
                                 {}};
  triad[2] = resolver_.text("cross(a, a1)", {{"a", triad[0]}, {"a1", triad[1]}}, written.span, vector);
  for (TypedNode& direction : triad) {
    if (end.frame == 0) continue;
    std::map<std::string, TypedNode> parts;
    for (std::uint32_t k = 0; k < 3; ++k) {
      parts[fmt::format("c{}", k + 1)] = resolver_.component(direction, k, written.span);
      parts[fmt::format("e{}", k + 1)] = own(k);
    }
    direction = resolver_.text("c1*e1 + c2*e2 + c3*e3", parts, written.span, vector);
  }
  return triad;
}

void JointsReader::joint_axes(const joints::Joint& kind, std::array<JointEnd, 2>& ends, const Value& table,
                              const std::string& what) {
  const Value* axis = table.find("axis");
  if (kind.axes == joints::AxisLayout::none) {
    if (axis != nullptr)
      source_.fail(axis->span, fmt::format("{} is of type {}, which has no axis", what, kind.name),
                   "remove 'axis', or choose another type");
    return;
  }
  require_value(table, "axis", what, "add axis = [\"vector of A\", \"vector of B\"], such as [\"A.e3\", \"B.e3\"]");
  if (axis->is(Value::Kind::array) && axis->items.size() == 2) {
    for (std::size_t k = 0; k < 2; ++k) ends[k].axis = triad_about(axis->items[k], ends[k], what);
    if (kind.axes == joints::AxisLayout::shared) return;
    StartSubstitution start = at_start(static_cast<std::uint32_t>(model_.constraints.size()));
    const NodeId a = start(ends[0].axis[0].node), b = a == no_node ? no_node : start(ends[1].axis[0].node);
    if (b == no_node) return;  // the initial state is checked instead
    const std::array<double, 3> u = Samples(model_).vector(a), v = Samples(model_).vector(b);
    const std::array<double, 3> across{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    if (magnitude(across) < parallel * magnitude(u) * magnitude(v)) {
      source_.fail(axis->span, fmt::format("the axes of {} are parallel at the start", what),
                   "the axes of a universal joint are at right angles: give one that is across the other");
    }
    return;
  }
  if (kind.axes == joints::AxisLayout::crossed) {
    source_.fail(axis->span, fmt::format("{} has two axes, one in each body, at right angles", what),
                 "write axis = [\"A.e1\", \"B.e2\"]");
  }
  if (axis->is(Value::Kind::array) && axis->items.size() != 3) {
    source_.fail(
        axis->span, fmt::format("'axis' of {} has {} entries", what, axis->items.size()),
        "write axis = [\"vector of A\", \"vector of B\"], or axis = \"<vector>\" for one as placed at the start");
  }
  const TypedNode direction =
      resolver_.value(*axis, {fmt::format("the axis of {}", what), on_motion, Shape::vector, std::nullopt,
                              "it is made of axes of bodies, E1, E2, E3 and parameters"});
  StartSubstitution start = at_start(scope_.find(table.find("name")->text)->index);
  const auto follows = [&](const JointEnd& end) {
    return end.frame != 0 && start(resolver_.own_axis(end.frame, 0, axis->span).node) == no_node;
  };
  const auto in_plane = [&](const JointEnd& end) { return own_axis_of_plane(direction, end.frame).has_value(); };
  if (in_plane(ends[0]) && in_plane(ends[1]) && (follows(ends[0]) || follows(ends[1]))) {
    for (JointEnd& end : ends) end.axis = triad_about(*axis, end, what);
    return;
  }
  axis_at_start(direction, ends, start, axis->span, what);
}

// One axis, given by the initial state, with two directions normal to it, all fixed in A; the axis is also fixed in B.
void JointsReader::axis_at_start(const TypedNode& direction, std::array<JointEnd, 2>& ends, StartSubstitution& start,
                                 Span span, const std::string& what) {
  const Context vector{what, on_anything, Shape::vector, std::nullopt, ""};
  const TypedNode placed = fixed_in_frame(direction, 0, start, span);
  const std::array<double, 3> v = Samples(model_).vector(placed.node);
  if (!(magnitude(v) > 0))
    source_.fail(span, fmt::format("the axis of {} has no direction at the start", what),
                 "give a vector that is not 0 there");
  std::size_t along = 3, least = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::abs(v[k]) < std::abs(v[least])) least = k;
    if (model_.arena[placed.node].op == Op::fixed_basis && model_.arena[placed.node].index == k) along = k;
  }
  std::array<TypedNode, 3> triad;
  const auto basis = [&](std::size_t k) { return resolver_.own_axis(0, k % 3, span); };
  if (along < 3) {
    triad = {basis(along), basis(along + 1), basis(along + 2)};
  } else {
    const std::map<std::string, TypedNode> local{{"v", placed}, {"c", basis(least)}};
    triad = {
        resolver_.text("unit(v)", local, span, vector), resolver_.text("unit(cross(v, c))", local, span, vector), {}};
    triad[2] = resolver_.text("cross(a, a1)", {{"a", triad[0]}, {"a1", triad[1]}}, span, vector);
  }
  for (std::size_t e = 0; e < 2; ++e) {
    for (std::size_t k = 0; k < 3; ++k) ends[e].axis[k] = fixed_in_frame(triad[k], ends[e].frame, start, span);
  }
}

}  // namespace eomgen::model
