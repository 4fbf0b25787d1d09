// SPDX-License-Identifier: GPL-3.0-or-later
// A generalised force as one force on a particle, along E1, E2, E3.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// F = J (J^T J)^-1 Q' with J = dr/dq of the coordinates that move the particle: the least F with F . dr/dq_i = Q'_i.
/// Q' is Q without the part of particles that hang on this one, whose forces follow from their own coordinates in the
/// same way. Empty if the coordinates that are left do not span the motion of the particle, since forces along the
/// others act on other masses too. `mass`: index into Mechanics::masses; `Q`: of all coordinates. Derivatives are
/// expanded with the constraints imposed.
std::optional<Vec3> force_on_particle(Mechanics& mechanics, std::size_t mass, const std::vector<Ref>& Q);

}  // namespace eomgen::mechanics
