// SPDX-License-Identifier: GPL-3.0-or-later
// position = { SYSTEM = [..], .. }: charts are expanded with the registry of coordinate systems; read_custom.cpp reads
// `custom` ones.
#include "model/read_positions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/read_names.hpp"
#include "model/samples.hpp"

namespace eomgen::model {
namespace {

bool is_bare_name(const Value& value) { return value.is(Value::Kind::text) && is_identifier(value.text); }

}  // namespace

void PositionsReader::declare_entries(const Value& position) {
  for (const Entry& entry : position.entries) {
    const coordinates::CoordinateSystem* system = coordinates::find(entry.key);
    if ((system == nullptr && entry.key != "custom") || !entry.value.is(Value::Kind::array)) continue;
    for (std::size_t k = 0; k < std::min<std::size_t>(3, entry.value.items.size()); ++k) {
      declare_entry(entry.value.items[k], system == nullptr ? "" : system->slots[k].unit);
    }
  }
}

// A coordinate of a custom system has no predefined unit: [coordinates] may state one.
void PositionsReader::declare_entry(const Value& entry, std::string_view unit) {
  if (!is_bare_name(entry)) return;
  const Symbol* known = scope_.find(entry.text);
  if (known == nullptr) {
    const Derivative derivative = split_derivative(entry.text);
    if (is_reserved(entry.text) || (derivative.order > 0 && scope_.find(derivative.base) != nullptr))
      return;  // reported later
    NamesReader(context_).declare_coordinate(entry.text, entry.span, nullptr);
    NamesReader(context_).warn_misspelt(entry.text, entry.span);
    known = scope_.find(entry.text);
  }
  if (known->kind != SymbolKind::coordinate || unit.empty()) return;
  if (coordinates_with_unit_.insert(known->index).second) {
    model_.coordinates[known->index].unit = Unit{std::string(unit), dimension_of(unit)};
  }
}

// The only entry of the table that names a coordinate system; keys of another system are rejected.
const Entry& PositionsReader::system_entry(const Value& table) const {
  Keys keys{"a position",
            {"from", "axes", "custom", "x", "q"},
            {{"polar", "cylindrical coordinates may leave out z: write cylindrical = [\"r\", \"theta\"]"}}};
  for (const coordinates::CoordinateSystem& system : coordinates::registry()) {
    keys.known.push_back(system.name);
    if (!system.constant.name.empty()) keys.known.push_back(system.constant.name);
  }
  check_keys(table, keys);
  const Entry* found = nullptr;
  for (const Entry& entry : table.entries) {
    if (entry.key != "custom" && coordinates::find(entry.key) == nullptr) continue;
    if (found != nullptr) source_.fail(entry.span, "a position is given in two coordinate systems", "keep one of them");
    found = &entry;
  }
  if (found == nullptr) {
    source_.fail(table.span, "the position names no coordinate system",
                 "write position = { cartesian = [\"x\", \"y\", \"z\"] } or { spherical = [..] }");
  }
  const coordinates::CoordinateSystem* system = coordinates::find(found->key);
  for (const Entry& entry : table.entries) {
    const bool of_custom = entry.key == "x" || entry.key == "q";
    const bool fits = &entry == found || entry.key == "from" || entry.key == "axes" ||
                      (system == nullptr ? of_custom : entry.key == system->constant.name);
    if (fits) continue;
    source_.fail(entry.span, fmt::format("'{}' does not belong to a position in {} coordinates", entry.key, found->key),
                 of_custom ? "x and q go with custom = [..]" : "leave it out");
  }
  return *found;
}

std::array<TypedNode, 3> PositionsReader::chart_entries(const coordinates::CoordinateSystem& system,
                                                        const Value& entries) {
  const std::string remedy =
      fmt::format("write {} = [\"{}\", \"{}\", \"{}\"]{}", system.name, system.slots[0].name, system.slots[1].name,
                  system.slots[2].name, system.planar ? ", or the first two in the plane" : "");
  require_kind(Value::Kind::array, entries, fmt::format("'{}'", system.name), remedy);
  const std::size_t count = entries.items.size();
  if (count != 3 && !(count == 2 && system.planar)) {
    source_.fail(entries.span, fmt::format("'{}' has {} entries", system.name, count), remedy);
  }
  std::array<TypedNode, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k >= count) {
      result[k] = resolver_.number(0, entries.span);
      continue;
    }
    const coordinates::Slot& slot = system.slots[k];
    Context context{fmt::format("the {} entry of the position", slot.name), on_motion, Shape::scalar,
                    dimension_of(slot.unit), ""};
    const Value& item = entries.items[k];
    const Symbol* symbol = is_bare_name(item) ? scope_.find(item.text) : nullptr;
    const bool bare = symbol != nullptr && symbol->kind == SymbolKind::coordinate;
    if (bare) context.dimension.reset();  // [coordinates] may state another
    result[k] = resolver_.value(item, context);
    const bool bounded = !slot.lower.empty() || !slot.upper.empty();
    if (!bare || !bounded || !coordinates_with_range_.insert(symbol->index).second) continue;
    const auto bound = [&](std::string_view text) {
      return text.empty() ? no_node : resolver_.text(text, {}, item.span, context).node;
    };
    const NodeId lower = bound(slot.lower), upper = bound(slot.upper);
    model_.coordinates[symbol->index].lower = lower;
    model_.coordinates[symbol->index].upper = upper;
  }
  return result;
}

// A position in a system of the registry: its expressions in terms of the entries and the constant.
PositionsReader::ExpandedPosition PositionsReader::expanded_position(const Value& table, const Entry& entry) {
  const coordinates::CoordinateSystem& system = *coordinates::find(entry.key);
  const Span span = entry.value.span;
  const std::array<TypedNode, 3> parts = chart_entries(system, entry.value);
  ExpandedPosition expanded;
  expanded.chart.system = std::string(system.name);
  expanded.chart.planar = entry.value.items.size() == 2;
  std::map<std::string, TypedNode> local;
  for (std::size_t k = 0; k < 3; ++k) {
    expanded.chart.entries[k] = parts[k].node;
    local[std::string(system.slots[k].name)] = parts[k];
  }
  if (const std::string key(system.constant.name); !key.empty()) {
    const Value& constant = require_value(table, key, fmt::format("a position in {} coordinates", system.name),
                                          fmt::format("add {} = \"..\" beside {}", key, system.name));
    local[key] = resolver_.value(
        constant, {fmt::format("'{}'", key), on_time, Shape::scalar, dimension_of(system.constant.unit), ""});
  }
  const Context context{"the position", on_motion, Shape::scalar, std::nullopt, ""};
  for (std::size_t k = 0; k < 3; ++k) expanded.x[k] = resolver_.text(system.x[k], local, span, context);
  for (std::size_t i = 0; i < 3; ++i) {
    if (system.e[i][0].empty()) continue;
    std::array<TypedNode, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = resolver_.text(system.e[i][k], local, span, context);
    expanded.chart.unit_basis[i] = resolver_.array_of(e, span).node;
  }
  return expanded;
}

// Dependent coordinates would make the mass matrix singular at every state.
void PositionsReader::check_independent(const ExpandedPosition& expanded, const Entry& entry, Span constant) {
  constexpr int points = 12;
  constexpr double smallest = 1e-9;  // squared sine of the angle between tangents; rounding errors are about 1e-18
  std::vector<std::uint32_t> coordinates;
  for (const NodeId id : expanded.chart.entries) {
    const Node& node = model_.arena[id];
    const bool known = std::find(coordinates.begin(), coordinates.end(), node.index) != coordinates.end();
    if (node.op == Op::coordinate && node.order == 0 && !known) coordinates.push_back(node.index);
  }
  Samples samples(model_);
  bool some = false;
  for (int k = 0; k < points; ++k) {
    samples.next();
    const double independence =
        samples.gram_determinant({expanded.x[0].node, expanded.x[1].node, expanded.x[2].node}, coordinates);
    if (independence > smallest) return;
    some = some || !std::isnan(independence);
  }
  if (!some) return;
  source_.fail(
      constant,
      fmt::format("these {} coordinates are singular everywhere: their basis vectors are dependent", entry.key),
      entry.key == "custom" ? "x(q) needs a Jacobian determinant that is not zero; check that every coordinate moves "
                              "the particle in its own direction"
                            : fmt::format("choose another {}", coordinates::find(entry.key)->constant.name));
}

TypedNode PositionsReader::position(std::uint32_t place, const Value& table) {
  const Entry& entry = system_entry(table);
  const Span span = entry.value.span;
  const coordinates::CoordinateSystem* system = coordinates::find(entry.key);
  ExpandedPosition expanded = system == nullptr ? custom_position(table, entry) : expanded_position(table, entry);
  if (system == nullptr) check_independent(expanded, entry, span);
  if (system != nullptr && !system->constant.name.empty()) {
    check_independent(expanded, entry, table.find(system->constant.name)->span);
  }
  TypedNode position = resolver_.array_of(expanded.x, span);
  if (const Value* axes = table.find("axes")) {
    const std::uint32_t frame = require_frame(*axes, "'axes'");
    const auto along = [&](const std::array<TypedNode, 3>& x) {
      TypedNode sum = resolver_.product_of(x[0], resolver_.own_axis(frame, 0, axes->span), span);
      for (std::size_t k = 1; k < 3; ++k) {
        sum = resolver_.sum_of(sum, resolver_.product_of(x[k], resolver_.own_axis(frame, k, axes->span), span), span);
      }
      return sum;
    };
    position = along(expanded.x);
    for (NodeId& e : expanded.chart.unit_basis) {
      if (e == no_node) continue;
      std::array<TypedNode, 3> components;
      for (std::size_t k = 0; k < 3; ++k) {
        components[k].node = model_.arena[e].args[k];
        components[k].literal = components[k].is_pure_number = true;
      }
      e = along(components).node;
    }
  }
  if (const Value* from = table.find("from")) {
    const std::uint32_t base = require_place(*from, "'from'");
    model_.places[place].from = base;
    if (base > 0) position = resolver_.sum_of(resolver_.place(base, from->span), position, span);
  }
  model_.places[place].chart = std::move(expanded.chart);
  return position;
}

}  // namespace eomgen::model
