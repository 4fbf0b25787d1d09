// SPDX-License-Identifier: GPL-3.0-or-later
// Inertial parameters that act like others of the body that carries theirs. In: Mechanics and a particle or body that
// is joined to another body, or to the ground. Out: the columns of its parameters as combinations of those of the
// carrier and of its own, for every motion of the carrier: twist and gravity along its axes are symbols of their own.
//
// The Lagrangian of a body is linear in its parameters (Siciliano et al., Robotics, 2009, section 7.2.2):
//   L = m v.v/2 + v.(w x m c) + w.Iw/2 + m g.r + m c.g.
#pragma once

#include <cstdint>
#include <optional>

#include "mechanics/mechanics.hpp"
#include "reading/column_relations.hpp"

namespace eomgen::reading {

/// Inertia 11, 12, 13, 22, 23, 33, moments, mass.
inline constexpr std::size_t body_parameters = 10;

struct CarriedInertia {
  std::optional<std::uint32_t> carrier;  // index into Model::bodies; none: the ground
  /// Columns: those of the carrier, then the own ones (of a particle its mass alone).
  Echelon relations;
};

/// Of Model::bodies[body]; without `body` of the particle at `place`. Empty if its position or rotation is no function
/// of coordinates along the axes of bodies and frames.
std::optional<CarriedInertia> carried_inertia(mechanics::Mechanics& mechanics, std::uint32_t place,
                                              std::optional<std::uint32_t> body);

}  // namespace eomgen::reading
