// SPDX-License-Identifier: GPL-3.0-or-later
// M_theta, f_theta of a tree of particles (branches.hpp), and what becomes of them in the coordinates of the model.
#pragma once

#include "derive/branches.hpp"
#include "derive/equations.hpp"

namespace eomgen::derive {

struct TreeEquations {
  Branches tree;
  FullEquations of_model;          // M = S^T M_theta S, f = S^T f_theta, of the coordinates that were asked for
  system::QuasiEquations quasi;    // the same before the transformation
};

/// True where the coordinates that move form a tree (and all coordinates do, where constraint forces are to be had).
bool tree_applies(Mechanics& mechanics, system::Approach approach);

TreeEquations tree_equations(Mechanics& mechanics, const std::vector<std::uint32_t>& of, bool imposed);

/// `assemble` with M and f of the motion; the constraint forces of eliminated coordinates come from the tree that all
/// coordinates form.
system::EquationSystem assemble_tree(Mechanics& mechanics, const TreeEquations& motion, const char* route,
                                     system::Approach approach);

}  // namespace eomgen::derive
