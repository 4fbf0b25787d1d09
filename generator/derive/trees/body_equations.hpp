// SPDX-License-Identifier: GPL-3.0-or-later
// M and f of a tree of bodies in the coordinates of the model, and their solution.
#pragma once

#include <optional>

#include "derive/trees/body_motion.hpp"

namespace eomgen::derive {

/// Solves M u' = f for trees of bodies.
using BodySolve = system::Solution (*)(Dag&, const BodyTree&, const std::vector<LinkMotion>&);

/// Empty if the bodies form no tree (body_tree.hpp), and in Approach I if there are constraints to impose. Without
/// multipliers and friction, angular velocities replace the rates of ball joints in the solution.
std::optional<system::EquationSystem> equations_of_bodies(Mechanics& mechanics, system::Approach approach,
                                                          const char* formulation, BodySolve solve);

}  // namespace eomgen::derive
