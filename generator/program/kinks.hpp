// SPDX-License-Identifier: GPL-3.0-or-later
// Kinks of the equations of motion (abs, sign, min, max, select, the cut of atan2) as switching surfaces. In: a system
// as derived. Out: the same system with branches that can be frozen, and the surfaces.
//
// Surface k is the argument of abs and sign, and a - b for min(a, b), max(a, b) and select(a < b). The symbol
// {SymbolKind::branch, k} selects the branch if it is not 0: 1 for positive values of the surface function, -1 for
// negative ones. With side 0 the system is unchanged.
#pragma once

#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::program {

struct Kink {
  symbolic::Op op;      // of the first occurrence
  symbolic::Ref value;  // changes sign at the surface; may contain sides of earlier ones
};

/// The name of the function that has the kink: "abs", "sign", "min", "max", "if", "atan2".
const char* name(const Kink& kink);

/// Whether the equations of motion have kinks that can be frozen.
bool has_kinks(system::EquationSystem system);

/// Makes the branches of the equations of motion and of the contact laws depend on sides, and equal branches in
/// reactions, outputs and events. Surfaces of parameters alone and surfaces of mode changes of contacts are unchanged.
/// Values of both signs (x - c, c - x) have one surface.
std::vector<Kink> freeze_kink_branches(system::EquationSystem& system);

}  // namespace eomgen::program
