// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/routes.hpp"

#include <algorithm>
#include <vector>

#include "work.hpp"

namespace eomgen::derive {
namespace {

const std::vector<RouteEntry>& all() {
#define ROUTE(name) route::name(),
  static const std::vector<RouteEntry> entries{
#include "derive/routes/registry.inc"
  };
#undef ROUTE
  return entries;
}

/// Whether most entries of the mass matrix are nonzero, as for a chain; branches near the root leave zeros.
bool is_full(const mechanics::Mechanics& m, const system::EquationSystem& s) {
  constexpr std::size_t share = 4;
  const auto filled = std::count_if(s.M.begin(), s.M.end(), [&](symbolic::Ref r) { return !m.dag->is_zero(r); });
  return static_cast<std::size_t>(filled) * share > s.M.size();
}

/// The tree formulations that remain efficient on larger trees than `route`, the one with the largest limit first.
std::vector<RouteEntry> cheaper_on_trees(const RouteEntry& route) {
  std::vector<RouteEntry> cheaper;
  for (const RouteEntry& other : routes()) {
    if (other.over_trees && other.worth_on_trees > route.worth_on_trees) cheaper.push_back(other);
  }
  std::stable_sort(cheaper.begin(), cheaper.end(),
                   [](const RouteEntry& a, const RouteEntry& b) { return a.worth_on_trees > b.worth_on_trees; });
  return cheaper;
}

/// A tree with a nearly full mass matrix is left to a cheaper formulation, if one applies.
bool is_left_to_another(const RouteEntry& route, mechanics::Mechanics& m, system::Approach approach) {
  if (m.q.size() <= route.worth_on_trees) return false;
  for (const RouteEntry& other : cheaper_on_trees(route)) {
    if (const auto s = other.derive(m, approach)) return is_full(m, *s);
  }
  return false;
}

}  // namespace

std::span<const RouteEntry> routes() { return all(); }

Outcome derive_where_worth(const RouteEntry& route, mechanics::Mechanics& m, system::Approach approach) {
  constexpr std::size_t operations = 20'000'000;
  if (is_left_to_another(route, m, approach)) return {std::nullopt, "a large tree has cheaper routes"};
  try {
    const work::Budget budget(operations);
    Outcome outcome{route.derive(m, approach), ""};
    if (!outcome.system) outcome.why = route.applies;
    return outcome;
  } catch (const work::OverBudget& over) {
    return {std::nullopt, over.what(), true};
  }
}

}  // namespace eomgen::derive
