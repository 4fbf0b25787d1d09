// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse dynamics: the forces of the constraints that prescribe a motion, as outputs of an EquationSystem
// (docs/theory.md, "Inverse dynamics").
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::analysis {

/// Labels of the constraints that read q = f(t).
std::vector<std::string> prescribing_constraints(const mechanics::Mechanics& mechanics);

/// Appends, of the constraints with these labels together, and returns the names of:
///   force.q            the generalised force sum lambda_k f_ki on a coordinate, where it is not identically 0;
///   P.force1 .. 3      the force on a particle whose coordinates (at most three) move nothing else: the one that these
///                      generalised forces determine, or the least one where they leave a component open;
///   prescribed.power   the work per time that they do: -sum lambda_k b_k.
std::vector<std::string> add_prescribed_forces(mechanics::Mechanics& mechanics, system::EquationSystem& system,
                                               const std::vector<std::string>& labels);

}  // namespace eomgen::analysis
