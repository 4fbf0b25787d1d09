// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/recursive.hpp"

#include "derive/tree_equations.hpp"

namespace eomgen::derive {

std::optional<system::EquationSystem> recursive(Mechanics& m, system::Approach approach) {
  const std::optional<TreeEquations> motion = motion_of_tree(m, approach);
  if (!motion) return std::nullopt;
  std::optional<system::EquationSystem> s = assemble_tree(m, *motion, "recursive", approach);
  if (s && !motion->tree.coordinates.identity()) s->quasi = motion->quasi;
  return s;
}

}  // namespace eomgen::derive
