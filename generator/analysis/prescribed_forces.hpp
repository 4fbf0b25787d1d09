// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse dynamics: adds the forces of constraints that prescribe a motion to the outputs of an EquationSystem
// (docs/theory.md, "Inverse dynamics").
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::analysis {

/// Labels of the constraints of the form q = f(t).
std::vector<std::string> prescribing_constraints(const mechanics::Mechanics& mechanics);

/// Appends the outputs below, summed over the constraints with these labels, and returns their names:
///   force.q            generalised force sum lambda_k f_ki on a coordinate, unless it is identically 0;
///   P.force1 .. 3      force on a particle whose coordinates (at most three) move nothing else; if the generalised
///                      forces do not determine it, the one of least magnitude;
///   prescribed.power   power of the constraints, -sum lambda_k b_k.
std::vector<std::string> add_prescribed_forces(mechanics::Mechanics& mechanics, system::EquationSystem& system,
                                               const std::vector<std::string>& labels);

}  // namespace eomgen::analysis
