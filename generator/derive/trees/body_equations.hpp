// SPDX-License-Identifier: GPL-3.0-or-later
// M and f of a tree of bodies in the coordinates of the model, and the same solved.
#pragma once

#include <optional>

#include "derive/equations.hpp"
#include "derive/trees/body_motion.hpp"

namespace eomgen::derive {

/// How M u' = f is solved for trees of bodies.
using BodySolve = system::Solution (*)(Dag&, const BodyTree&, const std::vector<LinkMotion>&);

/// Nothing where the bodies form no tree (body_tree.hpp), and by Approach I only where there is nothing to impose.
/// Solved with angular velocities in place of the rates of ball joints where no multipliers and no friction are.
std::optional<system::EquationSystem> equations_of_bodies(Mechanics& mechanics, system::Approach approach,
                                                          const char* route, BodySolve solve);

}  // namespace eomgen::derive
