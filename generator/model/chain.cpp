// SPDX-License-Identifier: GPL-3.0-or-later
// [[chain]]: n point masses on massless rods in the plane of E1 and E2, hanging along -E2 where all angles are 0.
#include "model/chain.hpp"

#include <fmt/format.h>

#include "model/read_names.hpp"
#include "model/read_places.hpp"

namespace eomgen::model {

void ChainsReader::declare(const Value& table) {
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
  const std::string coordinate = table.find("coordinate") == nullptr ? "theta" : text_of_key(table, "coordinate", what);
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
    chain.places.push_back(PlacesReader(context_).declare_place(
        fmt::format("{}{}", chain.name, k), table.find("name")->span, PlaceDeclaration{&table, true, false, index, k}));
  }
  chains_.push_back(std::move(chain));
}

// A value for all links, "m", or an array with one entry per link.
TypedNode ChainsReader::entry(const Value& table, std::string_view key, long link, const Context& context) {
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

TypedNode ChainsReader::position(const PlaceDeclaration& where) {
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

}  // namespace eomgen::model
