// SPDX-License-Identifier: GPL-3.0-or-later
// [[particle]], [[point]]: names, positions and masses.
#include <fmt/format.h>

#include <algorithm>

#include "model/reader.hpp"

namespace eomgen::model {
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
