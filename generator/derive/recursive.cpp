// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/recursive.hpp"

#include "derive/body_equations.hpp"
#include "derive/body_recursion.hpp"
#include "derive/tree_equations.hpp"

namespace eomgen::derive {
namespace {

/// The mass matrix of the whole, factorised.
system::Solution factorised(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion) {
  BodyEquations equations = body_equations(dag, tree, motion);
  const symbolic::Factorisation factors(dag, std::move(equations.M), equations.f.size(), symbolic::Ties::descending);
  return {factors.backward(factors.forward(equations.f)), factors.pivots()};
}

}  // namespace

std::optional<system::EquationSystem> recursive(Mechanics& m, system::Approach approach) {
  if (!m.spins.empty()) return equations_of_bodies(m, approach, "recursive", factorised);
  const std::optional<TreeEquations> motion = motion_of_tree(m, approach);
  if (!motion) return std::nullopt;
  std::optional<system::EquationSystem> s = assemble_tree(m, *motion, "recursive", approach);
  if (s && !motion->tree.coordinates.identity()) s->quasi = motion->quasi;
  return s;
}

}  // namespace eomgen::derive
