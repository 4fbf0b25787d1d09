// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/routes.hpp"

#include <algorithm>
#include <string_view>

#include "derive/articulated.hpp"
#include "derive/christoffel.hpp"
#include "derive/expanded.hpp"
#include "derive/jacobian.hpp"
#include "derive/lagrange.hpp"
#include "derive/recursive.hpp"
#include "work.hpp"

namespace eomgen::derive {
namespace {

// The one route that applies to every model.
std::optional<system::EquationSystem> by_lagrange(mechanics::Mechanics& m, system::Approach approach) {
  return lagrange(m, approach);
}

constexpr RouteEntry entries[] = {
    {"lagrange", "T and U differentiated as they stand", "applies to every model", by_lagrange},
    {"jacobian", "velocity Jacobians, M = sum m J^T J",
     "applies to models of particles and bodies without energies of their own", jacobian},
    {"recursive", "a tree of particles or bodies: composite masses, forces from the tips inwards",
     "applies to trees of particles or of bodies", recursive},
    {"articulated", "a tree of particles or bodies: link after link, no mass matrix",
     "applies to trees of particles or of bodies without multipliers and friction", articulated},
    {"christoffel", "M(q), Christoffel symbols of the first kind, expanded",
     "applies to small models whose kinetic energy stays short when it is multiplied out", christoffel},
    {"expanded", "T and U expanded first, sin^2 + cos^2 = 1 used",
     "applies to small models whose kinetic energy stays short when it is multiplied out", expanded},
};

}  // namespace

std::span<const RouteEntry> routes() { return entries; }

namespace {

/// Whether most of the mass matrix is filled, as along a chain; branches near the root leave it empty.
bool is_full(const mechanics::Mechanics& m, const system::EquationSystem& s) {
  constexpr std::size_t share = 4;
  const auto filled = std::count_if(s.M.begin(), s.M.end(), [&](symbolic::Ref r) { return !m.dag->is_zero(r); });
  return static_cast<std::size_t>(filled) * share > s.M.size();
}

bool is_for_trees(mechanics::Mechanics& m, system::Approach approach) {
  if (const auto s = articulated(m, approach)) return is_full(m, *s);
  const auto s = recursive(m, approach);
  return s && is_full(m, *s);
}

}  // namespace

Outcome derive_where_worth(const RouteEntry& route, mechanics::Mechanics& m, system::Approach approach) {
  constexpr std::size_t large = 16, very_large = 32;  // coordinates
  constexpr std::size_t operations = 20'000'000;
  const std::string_view name = route.name;
  if ((name == "lagrange" || name == "jacobian") && m.q.size() > large && is_for_trees(m, approach)) {
    return {std::nullopt, "a large tree has cheaper routes"};
  }
  if (name == "recursive" && m.q.size() > very_large) {
    const auto linear = articulated(m, approach);
    if (linear && is_full(m, *linear)) return {std::nullopt, "a large tree has cheaper routes"};
  }
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
