// SPDX-License-Identifier: GPL-3.0-or-later
// Approach II where an integrable constraint gives a coordinate in terms of the others. The new coordinate u = psi
// replaces that coordinate and is 0, eqs. (9.69), (9.86).
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// The same system without the coordinates that a frictionless constraint gives as functions of the others. Such a psi
/// is linear in the coordinate, with a nonzero factor that does not depend on the motion. The result shares the Dag.
Mechanics eliminate_dependent_coordinates(const Mechanics& mechanics);

}  // namespace eomgen::mechanics
