// SPDX-License-Identifier: GPL-3.0-or-later
// Which constraints on velocities are integrable, alone or together (Frobenius, t counted as a coordinate), and the
// integrals psi(q, t) = constant that are found; which constraints follow from others or contradict them.
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// Fills Mechanics::classification and Mechanics::integrals. Docs: docs/theory.md, "Integrability".
void classify_constraints(Mechanics& mechanics);

/// Throws Error{stage "mechanics"} naming the combination: "c3 = 2 c1".
void refuse_dependent_constraints(Mechanics& mechanics);

}  // namespace eomgen::mechanics
