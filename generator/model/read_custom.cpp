// SPDX-License-Identifier: GPL-3.0-or-later
// position = { custom = [q1, q2, q3], x = [..] } and/or q = [..]: coordinates that the user defines by x(q), by q(x) in
// x1, x2, x3, or by both. The result is x(q), checked numerically to be the inverse of q(x).
#include <fmt/format.h>

#include <cmath>

#include "model/inverse.hpp"
#include "model/read_positions.hpp"
#include "model/samples.hpp"

namespace eomgen::model {
namespace {

constexpr const char* custom_form = "write custom = [\"q1\", \"q2\", \"q3\"], x = [\"..\", \"..\", \"..\"]";
constexpr const char* give_x = "give x = [\"..\", \"..\", \"..\"] in terms of the coordinates too; it is then checked";

}  // namespace

PositionsReader::ExpandedPosition PositionsReader::custom_position(const Value& table, const Entry& entry) {
  require_kind(Value::Kind::array, entry.value, "'custom'", custom_form);
  if (entry.value.items.size() != 3) {
    source_.fail(entry.value.span, fmt::format("'custom' has {} entries", entry.value.items.size()), custom_form);
  }
  const Value *x = table.find("x"), *q = table.find("q");
  if (x == nullptr && q == nullptr) {
    source_.fail(entry.span, "custom coordinates are named here but not defined",
                 "add x = [..] in terms of them, or q = [..] in terms of x1, x2, x3");
  }
  for (const Value* list : {x, q}) {
    if (list == nullptr) continue;
    require_kind(Value::Kind::array, *list, list == x ? "'x'" : "'q'", custom_form);
    if (list->items.size() != 3) {
      source_.fail(list->span, fmt::format("'{}' has {} entries", list == x ? 'x' : 'q', list->items.size()),
                   "give three expressions");
    }
  }
  ExpandedPosition expanded;
  expanded.chart.system = "custom";
  for (std::size_t k = 0; k < 3; ++k) {
    const Value& item = entry.value.items[k];
    if (!item.is(Value::Kind::text) || !is_identifier(item.text)) {
      source_.fail(item.span, "an entry of custom is the name of a coordinate", custom_form);
    }
    expanded.chart.entries[k] =
        resolver_.value(item, {"an entry of the position", on_motion, Shape::scalar, std::nullopt, ""}).node;
  }
  const Context context{"the position", on_motion, Shape::scalar, dimension_of("m"), ""};
  if (x != nullptr) {
    for (std::size_t k = 0; k < 3; ++k) expanded.x[k] = resolver_.value(x->items[k], context);
  } else {
    expanded.x = solved_position(entry.value, *q, context);
  }
  if (q != nullptr) check_inverse(expanded, *q, x != nullptr);
  return expanded;
}

// Solves q(x), given alone, for x1, x2, x3.
std::array<TypedNode, 3> PositionsReader::solved_position(const Value& names, const Value& q, const Context& context) {
  std::array<Syntax, 3> f;
  std::array<std::string, 3> of;
  for (std::size_t k = 0; k < 3; ++k) {
    const Value& item =
        require_kind(Value::Kind::text, q.items[k], "an entry of q", "write an expression of x1, x2, x3 in quotes");
    f[k] = parse_quantity(source_text(source_, item));
    of[k] = names.items[k].text;
    for (const char* cartesian : cartesian_names) {
      if (of[k] != cartesian) continue;
      source_.fail(names.items[k].span, fmt::format("'{}' is a Cartesian coordinate in q = [..]", of[k]),
                   "give the coordinate another name, or give x = [..]");
    }
    const Symbol* symbol = scope_.find(of[k]);
    if (symbol != nullptr && symbol->kind == SymbolKind::coordinate) continue;
    source_.fail(names.items[k].span, fmt::format("'{}' is no coordinate, and q(x) defines three of them", of[k]),
                 give_x);
  }
  const auto solution = invert(f, of);
  if (!solution) {
    source_.fail(q.span, "q(x) cannot be solved for x1, x2, x3: no unknown can be isolated with a single value",
                 give_x);
  }
  std::array<TypedNode, 3> x;
  for (std::size_t k = 0; k < 3; ++k) x[k] = resolver_.tree((*solution)[k], context);
  return x;
}

// Checks q(x(q)) = q at sample points.
void PositionsReader::check_inverse(const ExpandedPosition& expanded, const Value& q, bool both) {
  constexpr int tries = 200, enough = 8;
  constexpr double tolerance = 1e-8;  // for values around 1 and a few roots and quotients
  std::map<std::string, TypedNode> local;
  for (std::size_t k = 0; k < 3; ++k) local[cartesian_names[k]] = expanded.x[k];
  std::array<NodeId, 3> back{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Context context{"an entry of q", on_time, Shape::scalar, std::nullopt,
                          "q is made of x1, x2, x3, parameters and functions of time"};
    back[k] = resolver_.value_with_names(q.items[k], local, context).node;
  }
  Samples samples(model_);
  int seen = 0;
  for (int k = 0; k < tries && seen < enough; ++k) {
    samples.next();
    bool finite = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const double was = samples.value(expanded.chart.entries[i]), is = samples.value(back[i]);
      finite = finite && std::isfinite(was) && std::isfinite(is);
      if (!finite || std::abs(is - was) <= tolerance * (1 + std::abs(was))) continue;
      source_.fail(
          q.items[i].span,
          fmt::format("q(x) and x(q) are not inverse: where this coordinate is {:.4g}, they give {:.4g}", was, is),
          both ? "correct one of them, or state in [coordinates] the range where they are inverse"
               : "state in [coordinates] a range where q(x) has one solution, or give x = [..] too");
    }
    if (finite) ++seen;
  }
  if (seen < enough) {
    source_.fail(q.span, "q(x) and x(q) could not be compared: they have values at too few points",
                 "state ranges in [coordinates] where both have values, or give x = [..] alone");
  }
}

}  // namespace eomgen::model
