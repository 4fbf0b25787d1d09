// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/recursive.hpp"

#include "derive/tree_equations.hpp"

namespace eomgen::derive {

bool recursive_applies(Mechanics& m, system::Approach approach) { return tree_applies(m, approach); }

system::EquationSystem recursive(Mechanics& m, system::Approach approach) {
  const TreeEquations motion = tree_equations(m, m.free, true);
  system::EquationSystem s = assemble_tree(m, motion, "recursive", approach);
  if (!motion.tree.coordinates.identity()) s.quasi = motion.quasi;
  return s;
}

}  // namespace eomgen::derive
