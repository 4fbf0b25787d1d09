// SPDX-License-Identifier: GPL-3.0-or-later
// [[particle]], [[point]] and their positions: charts are spelled out through the registry of coordinate systems.
#include <fmt/format.h>

#include <algorithm>

#include "model/reader.hpp"

namespace eomgen::model {
namespace {

bool is_bare_name(const Value& value) { return value.is(Value::Kind::text) && is_identifier(value.text); }

}  // namespace

std::uint32_t Reader::declare_place(const std::string& name, Span span, PlaceSource where) {
  Symbol& symbol = scope_.declare(SymbolKind::place, name, span);
  if (model_.places.size() > max_places) {
    source_.fail(span, fmt::format("the model has more than {} particles and points", max_places),
                 "a model of this size cannot be handled");
  }
  symbol.index = static_cast<std::uint32_t>(model_.places.size());
  Place place;
  place.name = name;
  place.span = span;
  model_.places.push_back(std::move(place));
  place_sources_.push_back(where);
  return symbol.index;
}

void Reader::declare_places() {
  struct Item {
    const Value* table;
    int kind;  // 0 particle, 1 point, 2 chain
  };
  std::vector<Item> items;
  int kind = 0;
  for (const char* name : {"particle", "point", "chain"}) {
    for (const Value* table : sections(name)) items.push_back({table, kind});
    ++kind;
  }
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.table->begin < b.table->begin; });
  for (const auto& [table, which] : items) {
    if (which == 2) {
      declare_chain(*table);
      continue;
    }
    if (which == 0) check_keys(*table, {"[[particle]]", {"name", "mass", "position"}, {}});
    if (which == 1) check_keys(*table, {"[[point]]", {"name", "position"}, {"on", "at"}});
    const std::string name = text_of_key(*table, "name", which == 0 ? "this [[particle]]" : "this [[point]]");
    declare_place(name, table->find("name")->span, PlaceSource{table, which == 0, 0, 0});
  }
}

// A bare unknown name in a position is a new coordinate. All other names are declared by now.
void Reader::declare_coordinates() {
  for (std::size_t k = 1; k < place_sources_.size(); ++k) {
    if (place_sources_[k].chain > 0) continue;
    const Value* position = place_sources_[k].table->find("position");
    if (position != nullptr && position->is(Value::Kind::table)) declare_entries(*position);
  }
}

void Reader::declare_entries(const Value& position) {
  for (const coordinates::CoordinateSystem* system : coordinates::registry()) {
    const Value* entries = position.find(system->name);
    if (entries == nullptr || !entries->is(Value::Kind::array)) continue;
    for (std::size_t k = 0; k < std::min<std::size_t>(3, entries->items.size()); ++k) {
      const Value& entry = entries->items[k];
      if (!is_bare_name(entry)) continue;
      const Symbol* known = scope_.find(entry.text);
      if (known == nullptr) {
        const Derivative derivative = split_derivative(entry.text);
        if (is_reserved(entry.text) || (derivative.order > 0 && scope_.find(derivative.base) != nullptr))
          continue;  // told later
        declare_coordinate(entry.text, entry.span, nullptr);
        warn_misspelt(entry.text, entry.span);
        known = scope_.find(entry.text);
      }
      if (known->kind != SymbolKind::coordinate) continue;
      Coordinate& coordinate = model_.coordinates[known->index];
      if (measured_.insert(known->index).second) {
        coordinate.unit = Unit{std::string(system->slots[k].unit), dimension_of(system->slots[k].unit)};
      }
    }
  }
}

Typed Reader::define_place(Symbol& symbol) {
  const PlaceSource where = place_sources_[symbol.index];
  Typed position;
  if (where.chain > 0) {
    position = chain_position(where);
  } else {
    const std::string what = fmt::format("'{}'", symbol.name);
    const Value& value = needed(*where.table, "position", what,
                                "add position = { cartesian = [\"x\", \"y\", \"z\"] } or a vector expression");
    if (value.is(Value::Kind::table)) {
      position = chart_position(symbol.index, value);
    } else {
      const Context context{fmt::format("the position of {}", what), on_motion, Shape::vector, dimension_of("m"), ""};
      position = resolver_.value(value, context);
    }
  }
  model_.places[symbol.index].position = position.node;
  return position;
}

const coordinates::CoordinateSystem& Reader::system_of(const Value& table, const Entry*& entries) const {
  Keys keys{"a position", {"from"}, {"axes", "parabolic", "helical", "oblique", "custom", "pitch", "angle", "x", "q"}};
  for (const coordinates::CoordinateSystem* system : coordinates::registry()) {
    keys.known.push_back(system->name);
    std::erase(keys.later, system->name);
    if (!system->constant.empty()) {
      keys.known.push_back(system->constant);
      std::erase(keys.later, system->constant);
    }
  }
  check_keys(table, keys);
  const coordinates::CoordinateSystem* found = nullptr;
  for (const Entry& entry : table.entries) {
    const coordinates::CoordinateSystem* system = coordinates::find(entry.key);
    if (system == nullptr) continue;
    if (found != nullptr) source_.fail(entry.span, "a position is given in two coordinate systems", "keep one of them");
    found = system;
    entries = &entry;
  }
  if (found == nullptr) {
    source_.fail(table.span, "the position names no coordinate system",
                 "write position = { cartesian = [\"x\", \"y\", \"z\"] } or { spherical = [..] }");
  }
  return *found;
}

std::array<Typed, 3> Reader::chart_entries(const coordinates::CoordinateSystem& system, const Value& entries) {
  const std::string remedy =
      fmt::format("write {} = [\"{}\", \"{}\", \"{}\"]{}", system.name, system.slots[0].name, system.slots[1].name,
                  system.slots[2].name, system.planar ? ", or the first two in the plane" : "");
  as(Value::Kind::array, entries, fmt::format("'{}'", system.name), remedy);
  const std::size_t count = entries.items.size();
  if (count != 3 && !(count == 2 && system.planar)) {
    source_.fail(entries.span, fmt::format("'{}' has {} entries", system.name, count), remedy);
  }
  std::array<Typed, 3> result;
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
    if (!bare || !bounded || !ranged_.insert(symbol->index).second) continue;
    const auto bound = [&](std::string_view text) {
      return text.empty() ? no_node : resolver_.text(text, {}, item.span, context).node;
    };
    const NodeId lower = bound(slot.lower), upper = bound(slot.upper);
    model_.coordinates[symbol->index].lower = lower;
    model_.coordinates[symbol->index].upper = upper;
  }
  return result;
}

Typed Reader::chart_position(std::uint32_t place, const Value& table) {
  const Entry* entries = nullptr;
  const coordinates::CoordinateSystem& system = system_of(table, entries);
  const Span span = entries->value.span;
  const std::array<Typed, 3> parts = chart_entries(system, entries->value);
  Chart chart;
  chart.system = std::string(system.name);
  chart.planar = entries->value.items.size() == 2;
  std::map<std::string, Typed> local;
  for (std::size_t k = 0; k < 3; ++k) {
    chart.entries[k] = parts[k].node;
    local[std::string(system.slots[k].name)] = parts[k];
  }
  const Context context{"the position", on_motion, Shape::scalar, std::nullopt, ""};
  std::array<Typed, 3> x;
  for (std::size_t k = 0; k < 3; ++k) x[k] = resolver_.text(system.x[k], local, span, context);
  Typed position = resolver_.array_of(x, span);
  for (std::size_t i = 0; i < 3; ++i) {
    if (system.e[i][0].empty()) continue;
    std::array<Typed, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = resolver_.text(system.e[i][k], local, span, context);
    chart.unit_basis[i] = resolver_.array_of(e, span).node;
  }
  if (const Value* from = table.find("from")) {
    const std::uint32_t base = place_named(*from, "'from'");
    model_.places[place].from = base;
    if (base > 0) position = resolver_.sum_of(resolver_.place(base, from->span), position, span);
  }
  model_.places[place].chart = std::move(chart);
  return position;
}

std::uint32_t Reader::place_named(const Value& value, const std::string& what) {
  as(Value::Kind::text, value, what, "write the name of a particle or point, or \"origin\"");
  if (value.text == "origin") return 0;
  Symbol* symbol = scope_.find(value.text);
  if (symbol == nullptr || symbol->kind != SymbolKind::place) {
    std::vector<std::string> places = scope_.names(SymbolKind::place);
    places.emplace_back("origin");
    const std::string hint = did_you_mean(value.text, places);
    source_.fail(value.span,
                 symbol == nullptr ? fmt::format("there is no particle or point {}", quote(value.text))
                                   : fmt::format("{} is {}, not a particle or point", quote(value.text),
                                                 model::kind_name(symbol->kind)),
                 hint.empty() ? "name a particle or point, or \"origin\"" : hint);
  }
  symbol->used = true;
  return symbol->index;
}

void Reader::read_particles() {
  for (std::uint32_t k = 1; k < model_.places.size(); ++k) {
    Symbol& symbol = *scope_.find(model_.places[k].name);
    resolver_.symbol(symbol, symbol.span);
    const PlaceSource where = place_sources_[k];
    if (!where.particle) continue;
    Particle particle;
    particle.place = k;
    particle.span = symbol.span;
    const std::string what = fmt::format("'{}'", symbol.name);
    const Context context{fmt::format("the mass of {}", what), on_time, Shape::scalar, dimension_of("kg"), ""};
    if (where.chain == 0) needed(*where.table, "mass", what, "add mass = \"m\" or a value such as \"2 kg\"");
    const Typed mass = where.chain > 0 ? chain_entry(*where.table, "mass", where.link, context)
                                       : resolver_.value(*where.table->find("mass"), context);
    if (mass.constant && !cln::plusp(*mass.constant)) {
      source_.fail(where.table->find("mass")->span, fmt::format("the mass of {} is not positive", what),
                   "a mass is greater than 0");
    }
    particle.mass = mass.node;
    model_.particles.push_back(particle);
  }
}

}  // namespace eomgen::model
