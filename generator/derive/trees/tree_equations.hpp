// SPDX-License-Identifier: GPL-3.0-or-later
// M_theta, f_theta of a tree of particles (branches.hpp), and what becomes of them in the coordinates of the model.
#pragma once

#include "derive/equations.hpp"
#include "derive/trees/branches.hpp"

namespace eomgen::derive {

struct TreeEquations {
  Branches tree;
  FullEquations of_model;        // M = S^T M_theta S, f = S^T f_theta, of the coordinates that were asked for
  system::QuasiEquations quasi;  // the same before the transformation
};

/// Of the coordinates that move, with the constraints imposed. Nothing where they form no tree, and by Approach I only
/// where there is nothing to impose.
std::optional<TreeEquations> motion_of_tree(Mechanics& mechanics, system::Approach approach);

/// `assemble` with M and f of the motion; the constraint forces of eliminated coordinates come from the tree that all
/// coordinates form: nothing where they form none.
std::optional<system::EquationSystem> assemble_tree(Mechanics& mechanics, const TreeEquations& motion,
                                                    const char* route, system::Approach approach);

}  // namespace eomgen::derive
