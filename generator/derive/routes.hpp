// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of routes to the equations of motion: each derives the same EquationSystem its own way, and no route
// includes another. What they share: all start from Mechanics and end with equations.hpp; lagrange and expanded
// differentiate energies with euler_lagrange.hpp; recursive and articulated find and describe a tree with trees/.
// docs/architecture.md, "What routes share", lists it file by file. verify holds them against one another and against
// the judge, which shares nothing with them.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

inline constexpr std::size_t any_size = static_cast<std::size_t>(-1);

struct RouteEntry {
  const char* name;
  const char* title;
  const char* applies;  // to what; told where the route is left out
  /// Nothing where the route does not apply to the model in this approach.
  std::optional<system::EquationSystem> (*derive)(mechanics::Mechanics&, system::Approach);
  /// Coordinates of a tree beyond which a route over trees that has a larger limit is cheaper by far.
  std::size_t worth_on_trees = any_size;
  bool over_trees = false;  // made for trees of particles or bodies
};

/// In the order of derive/routes/registry.inc, NAME() of derive/routes/NAME.cpp.
std::span<const RouteEntry> routes();

namespace route {
#define ROUTE(name) RouteEntry name();
#include "derive/routes/registry.inc"
#undef ROUTE
}  // namespace route

/// A route's equations, or why it is left out.
struct Outcome {
  std::optional<system::EquationSystem> system;
  std::string why;           // empty where there are equations
  bool over_budget = false;  // false: the route does not apply, or another one is cheaper by far
};

/// The route within a budget of operations; left out too where a tree is so large that another route is cheaper by far:
/// full matrices are left to small systems (docs/theory.md, "Routes").
Outcome derive_where_worth(const RouteEntry& route, mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
