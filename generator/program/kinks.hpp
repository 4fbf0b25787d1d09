// SPDX-License-Identifier: GPL-3.0-or-later
// Kinks of the equations of motion (abs, sign, min, max, select) as switching surfaces. In: a system as it was derived.
// Out: the same system whose branches can be held, and the surfaces.
//
// Surface k is the argument of abs and sign, a - b of min(a, b), max(a, b) and of select(a < b). In place of its value
// the branch is chosen by the symbol {SymbolKind::side, k} where that is not 0: 1 stands for values above 0, -1 for
// values below. With side 0 the system is what it was.
#pragma once

#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::program {

struct Kink {
  symbolic::Op op;      // by which it was met first
  symbolic::Ref value;  // changes its sign at the surface; may itself use sides of surfaces before it
};

/// The function that it is of: "abs", "sign", "min", "max", "if".
const char* name(const Kink& kink);

/// Bits of `mode` that hold sides: two for each kink, from first_kink_bit on; more kinks than that cannot be held.
inline constexpr std::size_t first_kink_bit = 8, most_kinks = 11;

/// Whether the equations of motion have any that can be held.
bool has_kinks(system::EquationSystem system);

/// Makes branches of the equations of motion and of the laws of contacts depend on sides, and in reactions, outputs and
/// events those that are the same. Surfaces of parameters alone and those where a contact changes its mode are left as
/// they are, and so is what exceeds most_kinks.
std::vector<Kink> hold_kinks(system::EquationSystem& system);

}  // namespace eomgen::program
