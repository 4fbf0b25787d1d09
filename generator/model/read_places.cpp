// SPDX-License-Identifier: GPL-3.0-or-later
// [[particle]], [[point]]: names, positions and masses.
#include "model/read_places.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/chain.hpp"
#include "model/read_bodies.hpp"
#include "model/read_positions.hpp"

namespace eomgen::model {
std::uint32_t PlacesReader::declare_place(const std::string& name, Span span, PlaceDeclaration where) {
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

void PlacesReader::declare() {
  struct Item {
    const Value* table;
    int kind;  // 0 particle, 1 point, 2 chain, 3 body, 4 frame
  };
  std::vector<Item> items;
  int kind = 0;
  for (const char* name : {"particle", "point", "chain", "body", "frame"}) {
    for (const Value* table : sections(name)) items.push_back({table, kind});
    ++kind;
  }
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.table->begin < b.table->begin; });
  for (const auto& [table, which] : items) {
    if (which == 2) {
      ChainsReader(context_).declare(*table);
      continue;
    }
    if (which == 0) check_keys(*table, {"[[particle]]", {"name", "mass", "position"}});
    if (which == 1) check_keys(*table, {"[[point]]", {"name", "position", "on", "at"}});
    if (which == 3)
      check_keys(*table, {"[[body]]", {"name", "mass", "inertia", "position", "rotation", "relative_to"}});
    if (which == 4) check_keys(*table, {"[[frame]]", {"name", "rotation", "relative_to"}});
    constexpr std::array<const char*, 5> kinds{"particle", "point", "chain", "body", "frame"};
    const std::string name =
        text_of_key(*table, "name", fmt::format("this [[{}]]", kinds[static_cast<std::size_t>(which)]));
    const Span span = table->find("name")->span;
    if (which == 4) {
      BodiesReader(context_).declare_frame(*table, 0, scope_.declare(SymbolKind::frame, name, span));
      continue;
    }
    const std::uint32_t place = declare_place(name, span, PlaceDeclaration{table, which == 0, which == 3, 0, 0});
    if (which == 3) BodiesReader(context_).declare_frame(*table, place, *scope_.find(name));
  }
}

// A bare unknown name in a position declares a coordinate. All other names are already declared.
void PlacesReader::declare_coordinates() {
  const auto position = [&](const Value& table) {
    const Value* found = table.find("position");
    if (found != nullptr && found->is(Value::Kind::table)) PositionsReader(context_).declare_entries(*found);
  };
  std::size_t place = 1;
  // The coordinates of a body's rotation follow those of its position; frames are ordered among the bodies as in the
  // file.
  for (std::size_t frame = 1; frame <= frame_sources_.size(); ++frame) {
    const std::size_t begin =
        frame < frame_sources_.size() ? frame_sources_[frame].table->begin : source_.text().size();
    for (; place < place_sources_.size() &&
           (place_sources_[place].chain > 0 || place_sources_[place].table->begin <= begin);
         ++place) {
      if (place_sources_[place].chain == 0) position(*place_sources_[place].table);
    }
    if (frame < frame_sources_.size()) BodiesReader(context_).declare_angles(*frame_sources_[frame].table);
  }
}

TypedNode PlacesReader::define_place(Symbol& symbol) {
  const PlaceDeclaration where = place_sources_[symbol.index];
  TypedNode position;
  if (where.chain > 0) {
    position = ChainsReader(context_).position(where);
  } else if (where.body && where.table->find("position") == nullptr) {
    position = resolver_.check_context(resolver_.number(0, symbol.span), symbol.span,
                                       Context{"a position", 0, Shape::vector, std::nullopt, ""});
  } else if (!where.particle && !where.body &&
             (where.table->find("on") != nullptr || where.table->find("at") != nullptr)) {
    position = BodiesReader(context_).point_on_body(*where.table, fmt::format("'{}'", symbol.name));
  } else {
    const std::string what = fmt::format("'{}'", symbol.name);
    const Value& value = require_value(*where.table, "position", what,
                                       "add position = { cartesian = [\"x\", \"y\", \"z\"] } or a vector expression");
    if (value.is(Value::Kind::table)) {
      position = PositionsReader(context_).position(symbol.index, value);
    } else {
      const Context context{fmt::format("the position of {}", what), on_motion, Shape::vector, dimension_of("m"), ""};
      position = resolver_.value(value, context);
    }
  }
  model_.places[symbol.index].position = position.node;
  return position;
}

void PlacesReader::read_particles() {
  for (std::uint32_t k = 1; k < model_.places.size(); ++k) {
    Symbol& symbol = *scope_.find(model_.places[k].name);
    resolver_.symbol(symbol, symbol.span);
    const PlaceDeclaration where = place_sources_[k];
    if (!where.particle) continue;
    Particle particle;
    particle.place = k;
    particle.span = symbol.span;
    const std::string what = fmt::format("'{}'", symbol.name);
    const Context context{fmt::format("the mass of {}", what), on_time, Shape::scalar, dimension_of("kg"), ""};
    if (where.chain == 0) require_value(*where.table, "mass", what, "add mass = \"m\" or a value such as \"2 kg\"");
    const TypedNode mass = where.chain > 0 ? ChainsReader(context_).entry(*where.table, "mass", where.link, context)
                                           : resolver_.value(*where.table->find("mass"), context);
    resolver_.require_positive_mass(mass, where.table->find("mass")->span, what);
    particle.mass = mass.node;
    model_.particles.push_back(particle);
  }
}

}  // namespace eomgen::model
