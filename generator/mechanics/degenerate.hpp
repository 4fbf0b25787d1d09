// SPDX-License-Identifier: GPL-3.0-or-later
// A constraint written as a square or a higher power, multiplied out or not: its gradient vanishes where it holds, so
// that no force along it could keep it. Seen in numbers, without taking it apart.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::mechanics {

/// Newton's method from a few points, along the gradient by the coordinates `of`: where all that come near psi = 0 do
/// so by a constant factor a step, its roots are multiple ones. False where no point comes near.
bool is_degenerate(const symbolic::Dag& dag, symbolic::Ref psi, const std::vector<symbolic::Symbol>& of,
                   const std::vector<symbolic::Ref>& gradient);

}  // namespace eomgen::mechanics
