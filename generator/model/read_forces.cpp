// SPDX-License-Identifier: GPL-3.0-or-later
// [[force]]: one kind each.
#include <fmt/format.h>

#include "model/reader.hpp"

namespace eomgen::model {
namespace {

constexpr Facts on_state = on_time | on_input | on_coordinate | on_velocity;

const std::vector<std::string_view>& kinds() {
  static const std::vector<std::string_view> all{"gravity", "central_gravity", "gravitation", "force",       "spring",
                                                 "damper",  "torsion",         "drag",        "generalized", "dry",
                                                 "moment",  "magnus"};
  return all;
}

}  // namespace

void Reader::declare_forces() {
  std::size_t number = 0;
  for (const Value* table : sections("force")) {
    Force force;
    force.span = table->span;
    force.name = fmt::format("force {}", ++number);
    if (table->find("name") != nullptr) {
      force.name = text_of_key(*table, "name", "this [[force]]");
      Symbol& symbol = scope_.declare(SymbolKind::force, force.name, table->find("name")->span);
      symbol.index = static_cast<std::uint32_t>(model_.forces.size());
    }
    model_.forces.push_back(std::move(force));
  }
}

void Reader::read_forces() {
  std::size_t index = 0;
  for (const Value* table : sections("force")) {
    const Span span = model_.forces[index].span;
    const std::string name = model_.forces[index].name;
    model_.forces[index] = read_force(*table, name);
    model_.forces[index].name = name;
    model_.forces[index].span = span;
    ++index;
  }
}

Force Reader::read_force(const Value& table, const std::string& name) {
  Keys keys{"[[force]]", kinds(), {}};
  keys.known.insert(keys.known.end(), {"name", "on"});
  check_keys(table, keys);
  const Entry* kind = nullptr;
  for (const Entry& entry : table.entries) {
    if (entry.key == "name" || entry.key == "on") continue;
    if (kind != nullptr) {
      source_.fail(entry.span, fmt::format("one [[force]] is both '{}' and '{}'", kind->key, entry.key),
                   "write one [[force]] for each");
    }
    kind = &entry;
  }
  if (kind == nullptr) {
    source_.fail(table.span, "this [[force]] says no kind of force",
                 fmt::format("add one of {}", fmt::join(kinds(), ", ")));
  }
  if (kind->key != "force" && kind->key != "moment" && table.find("on") != nullptr) {
    source_.fail(key_span(table, "on"), fmt::format("'on' does not belong to '{}'", kind->key),
                 "'on' says where a force vector acts: force = \"<vector>\", on = P");
  }
  const std::string what =
      table.find("name") != nullptr ? fmt::format("'{}'", name) : fmt::format("this {}", kind->key);
  const Value& value = kind->value;
  Force force;
  if (kind->key == "gravity") {
    const Context context{
        "gravity", on_time, Shape::vector, dimension_of("m/s^2"),
        "gravity is one acceleration for all masses; write force = \"<vector>\" with on = P, or central_gravity"};
    force.kind = Gravity{resolver_.value(value, context).node};
  } else if (kind->key == "force") {
    force.kind = read_applied(table, what);
  } else if (kind->key == "moment") {
    force.kind = read_moment(table, what);
  } else if (as(Value::Kind::table, value, what, fmt::format("write {} = {{ ... }}", kind->key));
             kind->key == "central_gravity") {
    force.kind = read_central_gravity(value, what);
  } else if (kind->key == "gravitation") {
    check_keys(value, {what, {"G"}, {}});
    force.kind = Gravitation{read_scalar(value, "G", what, "m^3/(kg*s^2)", on_time)};
  } else if (kind->key == "spring") {
    force.kind = read_spring(value, what);
  } else if (kind->key == "damper") {
    force.kind = read_damper(value, what);
  } else if (kind->key == "torsion") {
    force.kind = read_torsion(value, what);
  } else if (kind->key == "drag") {
    force.kind = read_drag(value, what);
  } else if (kind->key == "magnus") {
    force.kind = read_magnus(value, what);
  } else if (kind->key == "dry") {
    force.kind = read_dry(value, what);
  } else {
    force.kind = read_generalized(value, what);
  }
  return force;
}

NodeId Reader::read_scalar(const Value& table, std::string_view key, const std::string& what, std::string_view unit,
                           Facts allowed) {
  const Value& value = needed(table, key, what, fmt::format("add {} = \"..\"", key));
  const Context context{fmt::format("the {} of {}", key, what), allowed, Shape::scalar, dimension_of(unit), ""};
  return resolver_.value(value, context).node;
}

NodeId Reader::read_point(const Value& value, const std::string& what) {
  // A misspelt name of a particle deserves to be told as one.
  if (value.is(Value::Kind::text) && is_identifier(value.text) && scope_.find(value.text) == nullptr &&
      value.text != "origin" && !is_reserved(value.text)) {
    place_named(value, what);
  }
  const Context context{what, on_motion, Shape::vector, dimension_of("m"), ""};
  return resolver_.value(value, context).node;
}

AppliedForce Reader::read_applied(const Value& table, const std::string& what) {
  const Value& on = needed(table, "on", what, "add on = \"P\", the particle or point on which the force acts");
  const Context context{what == "this force" ? what : fmt::format("the force {}", what), on_state, Shape::vector,
                        dimension_of("N"), ""};
  AppliedForce result{};
  result.force = resolver_.value(*table.find("force"), context).node;
  result.at = read_point(on, "the point where a force acts");
  return result;
}

CentralGravity Reader::read_central_gravity(const Value& table, const std::string& what) {
  check_keys(table, {what, {"GM", "order", "center"}, {}});
  if (const Value* order = table.find("order")) {
    if (!order->is(Value::Kind::integer) || (order->text != "0" && order->text != "2")) {
      source_.fail(order->span, fmt::format("central_gravity has no order {}", quote(order->text)),
                   "write order = 0 or order = 2");
    }
    if (order->text == "2" && model_.bodies.empty()) {
      source_.fail(order->span,
                   "central_gravity of order 2 acts on what a [[body]] has of inertia, and the model has none",
                   "write order = 0");
    }
  }
  CentralGravity result{};
  if (const Value* order = table.find("order")) result.order = order->text == "2" ? 2 : 0;
  result.GM = read_scalar(table, "GM", what, "m^3/s^2", on_time);
  const Value* center = table.find("center");
  result.center = center != nullptr ? read_point(*center, fmt::format("the center of {}", what))
                                    : resolver_.place(0, table.span).node;
  return result;
}

std::array<NodeId, 2> Reader::read_between(const Value& table, const std::string& what) {
  const std::string remedy = "write between = [\"P\", \"Q\"] with particles, points, \"origin\" or vectors";
  const Value& between = needed(table, "between", what, remedy);
  as(Value::Kind::array, between, "'between'", remedy);
  if (between.items.size() != 2)
    source_.fail(between.span, fmt::format("'between' has {} entries", between.items.size()), remedy);
  const auto& ends = between.items;
  if (ends[0].is(Value::Kind::text) && ends[1].is(Value::Kind::text) && ends[0].text == ends[1].text) {
    source_.fail(between.span, fmt::format("both ends of {} are the same point", what), remedy);
  }
  return {read_point(ends[0], fmt::format("an end of {}", what)),
          read_point(ends[1], fmt::format("an end of {}", what))};
}

Spring Reader::read_spring(const Value& table, const std::string& what) {
  check_keys(table, {what, {"between", "stiffness", "length", "energy"}, {}});
  const auto ends = read_between(table, what);
  Spring result{ends[0], ends[1], no_node, no_node, no_node};
  const bool has_energy = table.find("energy") != nullptr;
  if (has_energy && table.find("stiffness") != nullptr) {
    source_.fail(key_span(table, "energy"), fmt::format("{} has both a stiffness and an energy", what),
                 "keep one of them");
  }
  result.length = table.find("length") != nullptr ? read_scalar(table, "length", what, "m", on_time)
                                                  : resolver_.number(0, table.span).node;
  if (!has_energy) {
    result.stiffness = read_scalar(table, "stiffness", what, "N/m", on_time);
    return result;
  }
  const Value& energy = *table.find("energy");
  if (const Symbol* other = scope_.find("extension")) {
    source_.fail(energy.span,
                 "'extension' means the extension of this spring here, and it is also declared in the model",
                 fmt::format("rename {} 'extension' of line {}", model::kind_name(other->kind), other->span.line));
  }
  Typed extension = resolver_.extension(energy.span);
  const Context context{fmt::format("the energy of {}", what), on_time, Shape::scalar, dimension_of("J"),
                        "the energy of a spring is an expression of extension, parameters and time"};
  const Typed typed = resolver_.value_with(energy, {{"extension", extension}}, context);
  result.energy = typed.node;
  return result;
}

Damper Reader::read_damper(const Value& table, const std::string& what) {
  check_keys(table, {what, {"between", "coefficient"}, {}});
  const auto ends = read_between(table, what);
  return Damper{ends[0], ends[1], read_scalar(table, "coefficient", what, "N*s/m", on_state)};
}

Torsion Reader::read_torsion(const Value& table, const std::string& what) {
  check_keys(table, {what, {"angle", "stiffness", "rest", "coefficient"}, {}});
  Torsion result{no_node, no_node, no_node, no_node};
  result.angle = read_scalar(table, "angle", what, "rad", on_motion);
  if (table.find("stiffness") == nullptr && table.find("coefficient") == nullptr) {
    source_.fail(table.span, fmt::format("{} has neither a stiffness nor a coefficient", what),
                 "add stiffness (a spring) or coefficient (a damper)");
  }
  if (table.find("rest") != nullptr && table.find("stiffness") == nullptr) {
    source_.fail(key_span(table, "rest"), fmt::format("{} has a rest angle and no stiffness", what),
                 "add stiffness, or leave rest out");
  }
  if (table.find("stiffness") != nullptr) {
    result.stiffness = read_scalar(table, "stiffness", what, "N*m", on_time);
    result.rest = resolver_.number(0, table.span).node;
  }
  if (table.find("rest") != nullptr) result.rest = read_scalar(table, "rest", what, "rad", on_time);
  if (table.find("coefficient") != nullptr)
    result.coefficient = read_scalar(table, "coefficient", what, "N*m*s", on_state);
  return result;
}

Drag Reader::read_drag(const Value& table, const std::string& what) {
  check_keys(table, {what, {"on", "density", "area", "coefficient"}, {}});
  Drag result{};
  const Value& on = needed(table, "on", what, "add on = \"P\"");
  result.on = resolver_.place(place_named(on, fmt::format("'on' of {}", what)), on.span).node;
  result.density = read_scalar(table, "density", what, "kg/m^3", on_state);
  result.area = read_scalar(table, "area", what, "m^2", on_state);
  result.coefficient = read_scalar(table, "coefficient", what, "1", on_state);
  return result;
}

Moment Reader::read_moment(const Value& table, const std::string& what) {
  const Value& on = needed(table, "on", what, "add on = \"B\", the body or frame on which the moment acts");
  Moment result{};
  result.frame = frame_named(on, fmt::format("'on' of {}", what));
  if (result.frame == 0) source_.fail(on.span, "a moment on the ground changes nothing", "name a body or frame");
  const Context context{what == "this moment" ? what : fmt::format("the moment {}", what), on_state, Shape::vector,
                        dimension_of("N*m"), ""};
  result.moment = resolver_.value(*table.find("moment"), context).node;
  return result;
}

Magnus Reader::read_magnus(const Value& table, const std::string& what) {
  check_keys(table, {what, {"on", "coefficient"}, {}});
  const Value& on = needed(table, "on", what, "add on = \"B\", the spinning body");
  const std::uint32_t frame = frame_named(on, fmt::format("'on' of {}", what));
  Magnus result{};
  bool found = false;
  for (std::uint32_t k = 0; k < model_.bodies.size(); ++k) {
    if (model_.bodies[k].frame != frame) continue;
    result.body = k;
    found = true;
  }
  if (!found)
    source_.fail(on.span, fmt::format("{} acts on a body, and '{}' has no mass", what, on.text), "name a [[body]]");
  result.coefficient = read_scalar(table, "coefficient", what, "1", on_state);
  return result;
}

Generalized Reader::read_generalized(const Value& table, const std::string& what) {
  Generalized result;
  if (table.entries.empty())
    source_.fail(table.span, fmt::format("{} names no coordinate", what), "write generalized = { x = \"F\" }");
  for (const Entry& entry : table.entries) {
    const Symbol* symbol = scope_.find(entry.key);
    if (symbol == nullptr || symbol->kind != SymbolKind::coordinate) {
      const std::string hint = did_you_mean(entry.key, scope_.names(SymbolKind::coordinate));
      source_.fail(entry.span, fmt::format("{} is not a coordinate", quote(entry.key)),
                   hint.empty() ? "the keys of 'generalized' are coordinates" : hint);
    }
    Context context{fmt::format("the generalized force along '{}'", entry.key), on_state, Shape::scalar, std::nullopt,
                    ""};
    const auto& dimension = model_.coordinates[symbol->index].unit.dimension;
    if (dimension) context.dimension = quotient(dimension_of("J"), *dimension);
    result.components.emplace_back(symbol->index, resolver_.value(entry.value, context).node);
  }
  return result;
}

}  // namespace eomgen::model
