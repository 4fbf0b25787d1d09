// SPDX-License-Identifier: GPL-3.0-or-later
// [[particle]], [[point]]: names, positions and masses.
#include "model/read_places.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/read_bodies.hpp"
#include "model/read_names.hpp"
#include "model/read_positions.hpp"

namespace eomgen::model {
namespace {

/// Reader of [[chain]], a shorthand for particles on rods.
class ChainsReader : private SectionReader {
 public:
  explicit ChainsReader(ReaderContext& context) : SectionReader(context) {}
  void declare(const Value& table) {
    check_keys(table, {"[[chain]]", {"name", "n", "mass", "length", "coordinate", "angles", "from"}});
    Chain chain;
    chain.table = &table;
    chain.name = text_of_key(table, "name", "this [[chain]]");
    const std::string what = fmt::format("the chain {}", quote(chain.name));
    const Value& n = require_value(table, "n", what, "add n = 6, the number of links");
    require_kind(Value::Kind::integer, n, "the number of links",
                 fmt::format("write a whole number from 1 to {}", max_chain));
    chain.n = n.text.size() > 4 ? 0 : std::stol(n.text);
    if (chain.n < 1 || chain.n > max_chain) {
      source_.fail(n.span, fmt::format("a chain of {} links", quote(n.text)),
                   fmt::format("write a whole number from 1 to {}", max_chain));
    }
    if (table.find("angles") != nullptr) {
      const std::string angles = text_of_key(table, "angles", what);
      if (angles != "absolute" && angles != "relative") {
        source_.fail(table.find("angles")->span, fmt::format("the angles of a chain cannot be {}", quote(angles)),
                     "write \"absolute\" or \"relative\"");
      }
      chain.relative = angles == "relative";
    }
    const std::string coordinate =
        table.find("coordinate") == nullptr ? "theta" : text_of_key(table, "coordinate", what);
    const Span coordinate_span = table.find("coordinate") == nullptr ? table.span : table.find("coordinate")->span;
    const auto index = static_cast<std::uint32_t>(chains_.size() + 1);
    for (long k = 1; k <= chain.n; ++k) {
      const std::string name = fmt::format("{}{}", coordinate, k);
      Symbol* known = scope_.find(name);
      if (known == nullptr || known->kind != SymbolKind::coordinate || known->entry == nullptr) {
        NamesReader(context_).declare_coordinate(name, coordinate_span, nullptr);
        known = scope_.find(name);
      }
      known->used = true;
      chain.coordinates.push_back(known->index);
      if (coordinates_with_unit_.insert(known->index).second)
        model_.coordinates[known->index].unit = Unit{"rad", Dimension{}};
      chain.places.push_back(PlacesReader(context_).declare_place(fmt::format("{}{}", chain.name, k),
                                                                  table.find("name")->span,
                                                                  PlaceDeclaration{&table, true, false, index, k}));
    }
    chains_.push_back(std::move(chain));
  }

  TypedNode position(const PlaceDeclaration& where) {
    const Chain& chain = chains_[where.chain - 1];
    const Value& table = *chain.table;
    const Span span = table.span;
    const auto k = static_cast<std::size_t>(where.link - 1);
    const Context context{"the length of a link", on_time, Shape::scalar, dimension_of("m"), ""};
    std::map<std::string, TypedNode> local;
    local["length"] = entry(table, "length", where.link, context);
    TypedNode angle = resolver_.coordinate(chain.coordinates[k], 0, span);
    if (chain.relative) {
      angle = resolver_.coordinate(chain.coordinates[0], 0, span);
      for (std::size_t j = 1; j <= k; ++j)
        angle = resolver_.sum_of(angle, resolver_.coordinate(chain.coordinates[j], 0, span), span);
    }
    local["angle"] = angle;
    const Context scalar{"the position of a link", on_motion, Shape::scalar, std::nullopt, ""};
    const TypedNode step =
        resolver_.array_of({resolver_.text("length*sin(angle)", local, span, scalar),
                            resolver_.text("-length*cos(angle)", local, span, scalar), resolver_.number(0, span)},
                           span);
    std::uint32_t base = 0;
    if (k > 0) {
      base = chain.places[k - 1];
    } else if (const Value* from = table.find("from")) {
      base = require_place(*from, "'from'");
    }
    model_.places[chain.places[k]].from = base;
    return base == 0 ? step : resolver_.sum_of(resolver_.place(base, span), step, span);
  }

  // A value for all links, "m", or an array with one entry per link.
  TypedNode entry(const Value& table, std::string_view key, long link, const Context& context) {
    const std::string what = "this [[chain]]";
    const Value& value = require_value(
        table, key, what, fmt::format("add {} = \"..\" for all links, or an array with one entry for each", key));
    if (!value.is(Value::Kind::array)) return resolver_.value(value, context);
    const Chain& chain =
        chains_[place_sources_[scope_.find(table.find("name")->text + std::to_string(link))->index].chain - 1];
    if (value.items.size() != static_cast<std::size_t>(chain.n)) {
      source_.fail(value.span,
                   fmt::format("'{}' has {} entries, and the chain has {} links", key, value.items.size(), chain.n),
                   "give one value for all links, or one for each");
    }
    return resolver_.value(value.items[static_cast<std::size_t>(link - 1)], context);
  }
};

}  // namespace

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
