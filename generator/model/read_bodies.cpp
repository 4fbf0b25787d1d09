// SPDX-License-Identifier: GPL-3.0-or-later
// [[body]], [[frame]]: rotating axes, expanded with the registry of rotations; points on bodies.
#include "model/read_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/read_inertia.hpp"
#include "model/read_positions.hpp"

namespace eomgen::model {
namespace {

constexpr const char* rotation_form =
    "write rotation = { euler = \"313\", angles = [\"phi\", \"theta\", \"psi\"] }, { axis = \"E3\", angle = \"phi\" }, "
    "{ euler_parameters = [..] }, { rodrigues = [..] } or { fixed = true }";

}  // namespace

void BodiesReader::declare_frame(const Value& table, std::uint32_t place, Symbol& symbol) {
  Frame frame;
  frame.name = symbol.name;
  frame.span = symbol.span;
  symbol.frame = static_cast<std::uint32_t>(model_.frames.size());
  symbol.state = symbol.kind == SymbolKind::frame ? Symbol::State::resolved : symbol.state;
  scope_.declare_axes(symbol.name, symbol.span);
  model_.frames.push_back(std::move(frame));
  frame_sources_.push_back({&table, place});
}

// Declares new names in angles = [..], euler_parameters = [..], rodrigues = [..] and angle = ".." as coordinates.
void BodiesReader::declare_angles(const Value& table) {
  const Value* rotation = table.find("rotation");
  if (rotation == nullptr || !rotation->is(Value::Kind::table)) return;
  for (const Entry& entry : rotation->entries) {
    const bool angles = entry.key == "angles" || entry.key == "angle";
    if (!angles && entry.key != "euler_parameters" && entry.key != "rodrigues") continue;
    const char* unit = angles ? "rad" : "1";
    if (entry.key == "angle") PositionsReader(context_).declare_entry(entry.value, unit);
    for (const Value& item : entry.value.items) PositionsReader(context_).declare_entry(item, unit);
  }
}

const Entry& BodiesReader::rotation_entry(const Value& rotation) const {
  require_kind(Value::Kind::table, rotation, "a rotation", rotation_form);
  check_keys(rotation, {"a rotation", {"euler", "angles", "axis", "angle", "euler_parameters", "rodrigues", "fixed"}});
  const Entry* found = nullptr;
  for (const Entry& entry : rotation.entries) {
    if (entry.key == "angles" || entry.key == "angle") continue;
    if (found != nullptr)
      source_.fail(entry.span, fmt::format("a rotation is both '{}' and '{}'", found->key, entry.key),
                   "keep one of them");
    found = &entry;
  }
  if (found == nullptr) source_.fail(rotation.span, "the rotation states no kind", rotation_form);
  for (const Entry& entry : rotation.entries) {
    const bool fits = &entry == found || (entry.key == "angles" && found->key == "euler") ||
                      (entry.key == "angle" && found->key == "axis");
    if (!fits)
      source_.fail(entry.span, fmt::format("'{}' does not belong to a rotation by '{}'", entry.key, found->key),
                   rotation_form);
  }
  return *found;
}

// Returns the values of the entries and sets the name of the representation.
std::vector<const Value*> BodiesReader::rotation_entries(Frame& frame, const rotations::Rotation& found,
                                                         const Entry& entry, const Value& rotation) {
  frame.rotation = found.name;
  if (found.family == "fixed") {
    if (!require_kind(Value::Kind::boolean, entry.value, "'fixed'", "write fixed = true").boolean)
      source_.fail(entry.value.span, "a rotation cannot be fixed = false", rotation_form);
    return {};
  }
  if (found.family == "axis")
    return {&require_value(rotation, "angle", "a rotation about an axis", "add angle = \"phi\"")};
  const bool euler = found.family == "euler";
  const Value& list = euler ? require_value(rotation, "angles", "a rotation by Euler angles",
                                            "add angles = [\"phi\", \"theta\", \"psi\"]")
                            : entry.value;
  const std::string what = euler ? "'angles'" : fmt::format("'{}'", entry.key);
  require_kind(Value::Kind::array, list, what, rotation_form);
  if (list.items.size() != found.entries.size()) {
    source_.fail(list.span, fmt::format("{} has {} entries", what, list.items.size()),
                 fmt::format("give {} of them", found.entries.size()));
  }
  std::vector<const Value*> result;
  for (const Value& item : list.items) result.push_back(&item);
  return result;
}

TypedNode BodiesReader::define_axes(Symbol& symbol) {
  const std::uint32_t index = symbol.index;
  const Value& table = *frame_sources_[index].table;
  const std::string what = fmt::format("'{}'", model_.frames[index].name);
  const Value& rotation = require_value(table, "rotation", what, rotation_form);
  Frame frame = model_.frames[index];
  if (const Value* parent = table.find("relative_to")) frame.parent = require_frame(*parent, "'relative_to'");
  if (frame.parent > 0) symbol.typed = resolver_.symbol(scope_.axes(frame.parent), table.find("relative_to")->span);
  model_.frames[index] = frame;
  read_rotation(frame, index, rotation);
  return symbol.typed;
}

void BodiesReader::read_rotation(Frame& frame, std::uint32_t index, const Value& rotation) {
  const Entry& entry = rotation_entry(rotation);
  std::string name = entry.key;
  if (entry.key == "euler") {
    name = require_kind(Value::Kind::text, entry.value, "'euler'", "write euler = \"313\"").text;
    const rotations::Rotation* set = rotations::find(name);
    if (set == nullptr || set->family != "euler") {
      std::string sets;
      for (const rotations::Rotation& r : rotations::registry()) {
        if (r.family == "euler") sets += (sets.empty() ? "" : ", ") + r.name;
      }
      source_.fail(entry.value.span, fmt::format("there are no Euler angles {}", quote(name)),
                   "the twelve sets are " + sets);
    }
  }
  const rotations::Rotation& found = *rotations::find(name);
  const std::vector<const Value*> values = rotation_entries(frame, found, entry, rotation);
  std::map<std::string, TypedNode> local;
  TypedNode& all = scope_.axes(index).typed;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Context context{fmt::format("an entry of the rotation of '{}'", frame.name), on_motion, Shape::scalar,
                          dimension_of(found.entries[k].unit),
                          "angles are made of coordinates, functions of time, parameters and t"};
    const TypedNode typed = resolver_.value(*values[k], context);
    if (!found.unit.empty() && model_.arena[typed.node].op != Op::coordinate) {
      source_.fail(values[k]->span, "an Euler parameter is a coordinate of its own", "give it a name, such as \"e0\"");
    }
    frame.entries.push_back(typed.node);
    local[found.entries[k].name] = typed;
    local[found.entries[k].name + "_dot"] = resolver_.rate(typed, values[k]->span);
    all.dependencies |= typed.dependencies;
    all.depth = std::max(all.depth, typed.depth + 2);
  }
  model_.frames[index].rotation = frame.rotation;
  model_.frames[index].entries = frame.entries;
  if (found.family == "axis") {
    read_axis_rotation(frame, index, rotation, local);
  } else {
    for (const rotations::Step& step : found.steps) add_stage(index, step, local, rotation.span);
    if (!found.singularity.empty()) {
      const Context context{"a rotation", on_anything, Shape::scalar, std::nullopt, ""};
      model_.frames[index].singularity = resolver_.text(found.singularity, local, rotation.span, context).node;
    }
    if (found.family == "fixed") {
      frame_sources_[index].axis = frame_sources_[frame.parent].axis;
      frame_sources_[index].keeps_attitude = frame_sources_[frame.parent].keeps_attitude;
      frame_sources_[index].starts_aligned = frame.parent == 0 || frame_sources_[frame.parent].starts_aligned;
    }
  }
}

// A rotation about an axis fixed in the parent: one of its axes, or a sum of them with constant components.
void BodiesReader::read_axis_rotation(Frame& frame, std::uint32_t index, const Value& rotation,
                                      std::map<std::string, TypedNode>& local) {
  const Value& written = *rotation.find("axis");
  const std::string of =
      frame.parent == 0 ? "E1, E2, E3" : fmt::format("{0}.e1, {0}.e2, {0}.e3", model_.frames[frame.parent].name);
  const Context context{
      fmt::format("the axis of the rotation of '{}'", frame.name), frame.parent == 0 ? Dependencies{0} : on_motion,
      Shape::vector, std::nullopt,
      "the axis is fixed in the parent: make it of " + of + "; relative_to = \"B\" names another parent"};
  const TypedNode axis = resolver_.value(written, context);
  const auto parallel = [](const std::array<cln::cl_RA, 3>& a, const std::array<cln::cl_RA, 3>& b) {
    return a[0] * b[1] == a[1] * b[0] && a[0] * b[2] == a[2] * b[0] && a[1] * b[2] == a[2] * b[1];
  };
  const FrameDeclaration& parent = frame_sources_[frame.parent];
  // In plane motion all bodies rotate about E3.
  const auto in_space = numbers_of(axis.node);
  const bool common = parent.has_axes_of_space() || (parent.starts_aligned && parent.axis && parent.axis->numbers &&
                                                     in_space && parallel(*parent.axis->numbers, *in_space));
  const TypedNode along = frame.parent == 0 || common ? axis : resolver_.in_axes(axis, frame.parent);
  if (along.node == no_node) {
    source_.fail(written.span, "this axis is not fixed in the parent",
                 "make it of " + of + " with constant components");
  }
  FixedDirection direction;
  direction.numbers = numbers_of(along.node);
  const TypedNode unit = resolver_.unit_of_vector(along, written.span);
  for (std::uint32_t k = 0; k < 3; ++k)
    direction.unit[k] = local["r" + std::to_string(k + 1)] = resolver_.component(unit, k, written.span);
  const bool same =
      parent.axis && parent.axis->numbers && direction.numbers && parallel(*parent.axis->numbers, *direction.numbers);
  frame_sources_[index].keeps_attitude = parent.keeps_attitude && local.at("angle").dependencies == 0;
  if (parent.keeps_attitude || same) frame_sources_[index].axis = direction;
  frame_sources_[index].starts_aligned =
      frame.parent == 0 || parent.has_axes_of_space() || (parent.starts_aligned && same);
  const Node& node = model_.arena[along.node];
  if (node.op == Op::fixed_basis) {
    add_stage(index, rotations::about_axis(node.index, "angle"), local, rotation.span);
  } else {
    add_stage(index, rotations::find("axis")->steps[0], local, rotation.span);
  }
}

/// The components of a sum of numbers times E1, E2, E3; nothing for other vectors.
std::optional<std::array<cln::cl_RA, 3>> BodiesReader::numbers_of(NodeId vector) const {
  const Node& node = model_.arena[vector];
  std::array<cln::cl_RA, 3> result{0, 0, 0};
  const auto combined = [&](const cln::cl_RA& left, std::size_t a, const cln::cl_RA& right,
                            std::size_t b) -> std::optional<std::array<cln::cl_RA, 3>> {
    const auto x = numbers_of(node.args[a]), y = numbers_of(node.args[b]);
    if (!x || !y) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) result[k] = left * (*x)[k] + right * (*y)[k];
    return result;
  };
  switch (node.op) {
    case Op::fixed_basis: result[node.index] = 1; return result;
    case Op::negate: return combined(-1, 0, 0, 0);
    case Op::add: return combined(1, 0, 1, 1);
    case Op::subtract: return combined(1, 0, -1, 1);
    case Op::multiply:
    case Op::divide: {
      const std::size_t v = model_.arena[node.args[0]].vector ? 0 : 1;
      const Node& factor = model_.arena[node.args[1 - v]];
      if (factor.op != Op::number || cln::zerop(factor.value)) return std::nullopt;
      return combined(node.op == Op::multiply ? factor.value : cln::recip(factor.value), v, 0, v);
    }
    default: return std::nullopt;
  }
}

void BodiesReader::add_stage(std::uint32_t index, const rotations::Step& step,
                             const std::map<std::string, TypedNode>& local, Span span) {
  const Context context{"a rotation", on_anything, Shape::scalar, std::nullopt, ""};
  const std::size_t before = model_.frames[index].stages.size();
  const std::uint32_t parent = model_.frames[index].parent;
  RotationStage stage;
  for (std::size_t k = 0; k < 3; ++k) {
    stage.R[k] = {no_node, no_node, no_node};
    std::optional<TypedNode> sum;
    for (std::size_t j = 0; j < 3; ++j) {
      if (step.R[k][j] == "0") continue;
      const TypedNode factor = resolver_.text(step.R[k][j], local, span, context);
      const TypedNode axis =
          before == 0 ? resolver_.own_axis(parent, j, span) : resolver_.axis(index, before - 1, j, span);
      const TypedNode term = step.R[k][j] == "1" ? axis : resolver_.product_of(factor, axis, span);
      stage.R[k][j] = factor.node;
      sum = sum ? resolver_.sum_of(*sum, term, span) : term;
    }
    stage.e[k] = sum->node;
    if (step.w[k] != "0") stage.w[k] = resolver_.text(step.w[k], local, span, context).node;
  }
  model_.frames[index].stages.push_back(stage);
}

TypedNode BodiesReader::point_on_body(const Value& table, const std::string& what) {
  if (const Value* position = table.find("position")) {
    source_.fail(position->span, fmt::format("{} is on a body and has a position too", what), "keep one of them");
  }
  const Value& on = require_value(table, "on", what, "add on = \"B\", the body that carries the point");
  const Value& at =
      require_value(table, "at", what, "add at = [x, y, z] along the body's axes, from its centre of mass");
  const std::uint32_t frame = require_frame(on, "'on'");
  if (frame == 0 || frame_sources_[frame].place == 0) {
    source_.fail(on.span, "a point is on a body, and this has no centre of mass",
                 "name a [[body]], or give position = \"<vector>\"");
  }
  require_kind(Value::Kind::array, at, "'at'", "write at = [x, y, z] along the body's axes");
  if (at.items.size() != 3)
    source_.fail(at.span, fmt::format("'at' has {} entries", at.items.size()), "write at = [x, y, z]");
  TypedNode sum = resolver_.place(frame_sources_[frame].place, on.span);
  const Context context{"a component of 'at'", on_motion, Shape::scalar, dimension_of("m"), ""};
  for (std::size_t k = 0; k < 3; ++k) {
    const TypedNode component = resolver_.value(at.items[k], context);
    if (component.constant && cln::zerop(*component.constant)) continue;
    sum =
        resolver_.sum_of(sum, resolver_.product_of(component, resolver_.own_axis(frame, k, on.span), at.span), at.span);
  }
  return sum;
}

void BodiesReader::read() {
  for (std::uint32_t k = 1; k < model_.frames.size(); ++k) resolver_.symbol(scope_.axes(k), model_.frames[k].span);
  for (std::uint32_t k = 1; k < model_.frames.size(); ++k) {
    const FrameDeclaration source = frame_sources_[k];
    if (source.place == 0) continue;
    Body body;
    body.place = source.place;
    body.frame = k;
    body.span = model_.frames[k].span;
    const std::string what = fmt::format("'{}'", model_.frames[k].name);
    const Value& value = require_value(*source.table, "mass", what, "add mass = \"m\" or a value such as \"2 kg\"");
    const TypedNode mass = resolver_.value(
        value, {fmt::format("the mass of {}", what), 0, Shape::scalar, dimension_of("kg"),
                "the mass of a body is made of numbers and parameters; that of a [[particle]] may depend on time"});
    resolver_.require_positive_mass(mass, value.span, what);
    body.mass = mass.node;
    InertiaReader(context_).read(body, *source.table);
    model_.bodies.push_back(body);
  }
}

namespace {

bool by_parameters(const Value& table) {
  const Value* rotation = table.find("rotation");
  return rotation != nullptr && rotation->is(Value::Kind::table) && rotation->find("euler_parameters") != nullptr;
}

}  // namespace

// Declares the unit norm of Euler parameters: a constraint NAME_unit for each body or frame that uses them.
void BodiesReader::declare_units() {
  for (std::uint32_t k = 1; k < model_.frames.size(); ++k) {
    if (!by_parameters(*frame_sources_[k].table)) continue;
    Constraint constraint;
    constraint.name = model_.frames[k].name + "_unit";
    constraint.unit = true;
    constraint.span = frame_sources_[k].table->find("rotation")->span;
    Symbol& symbol = scope_.declare(SymbolKind::constraint, constraint.name, constraint.span);
    symbol.index = static_cast<std::uint32_t>(model_.constraints.size());
    model_.constraints.push_back(std::move(constraint));
  }
}

void BodiesReader::read_units() {
  for (const Frame& frame : model_.frames) {
    const rotations::Rotation* rotation = rotations::find(frame.rotation);
    if (rotation == nullptr || rotation->unit.empty()) continue;
    std::map<std::string, TypedNode> local;
    for (std::size_t k = 0; k < frame.entries.size(); ++k) {
      local[rotation->entries[k].name] = resolver_.coordinate(model_.arena[frame.entries[k]].index, 0, frame.span);
    }
    Constraint& constraint = model_.constraints[scope_.find(frame.name + "_unit")->index];
    const Context context{"the length of Euler parameters", on_motion, Shape::scalar, std::nullopt, ""};
    constraint.psi = {resolver_.text(rotation->unit, local, constraint.span, context).node};
  }
}

}  // namespace eomgen::model
