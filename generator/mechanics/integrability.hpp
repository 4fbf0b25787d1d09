// SPDX-License-Identifier: GPL-3.0-or-later
// Which constraints on velocities are integrable, alone or together (Frobenius, t counted as a coordinate), and the
// integrals psi(q, t) = constant that are found.
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// Fills Mechanics::classification and Mechanics::integrals. Docs: docs/theory.md, "Integrability".
void classify_constraints(Mechanics& mechanics);

}  // namespace eomgen::mechanics
