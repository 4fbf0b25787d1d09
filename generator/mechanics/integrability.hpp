// SPDX-License-Identifier: GPL-3.0-or-later
// Integrability of velocity constraints, alone or together (Frobenius' theorem, with t as a coordinate), and the
// integrals psi(q, t) = constant that are found.
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// Fills Mechanics::classification and Mechanics::integrals. Docs: docs/theory.md, "Integrability".
void classify_constraints(Mechanics& mechanics);

}  // namespace eomgen::mechanics
