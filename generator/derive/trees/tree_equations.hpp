// SPDX-License-Identifier: GPL-3.0-or-later
// M_theta, f_theta of a tree of particles (particle_tree.hpp), and their transformation to the coordinates of the
// model.
#pragma once

#include "derive/equations.hpp"
#include "derive/trees/particle_tree.hpp"

namespace eomgen::derive {

struct TreeEquations {
  ParticleTree tree;
  FullEquations of_model;                // M = S^T M_theta S, f = S^T f_theta, of the requested coordinates
  system::QuasiVelocityEquations quasi;  // the same before the transformation
};

/// The equations of the free coordinates, with the constraints imposed. Empty if they form no tree, and in Approach I
/// if there are constraints to impose.
std::optional<TreeEquations> derive_tree_motion(Mechanics& mechanics, system::Approach approach);

/// Calls `assemble` with M and f of the motion. The constraint forces of eliminated coordinates come from the tree of
/// all coordinates: empty if they form none.
std::optional<system::EquationSystem> assemble_tree(Mechanics& mechanics, const TreeEquations& motion,
                                                    const char* formulation, system::Approach approach);

}  // namespace eomgen::derive
