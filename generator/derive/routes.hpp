// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of fast routes: each derives the same EquationSystem its own way. No route includes
// another; what several are made of (bodies, trees, Euler and Lagrange's equations) has files of its own, and the
// certificate tells which pairs share code. verify holds them against one another and against the judge.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

struct RouteEntry {
  const char* name;
  const char* title;
  const char* applies;  // to what; told where the route is left out
  /// Nothing where the route does not apply to the model in this approach.
  std::optional<system::EquationSystem> (*derive)(mechanics::Mechanics&, system::Approach);
};

std::span<const RouteEntry> routes();

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
