// SPDX-License-Identifier: GPL-3.0-or-later
// The motions of bodies, particles and points, as Dag expressions like those of an EquationSystem.
#pragma once

#include <array>
#include <cstdint>

#include "symbolic/dag.hpp"

namespace eomgen::system {

/// Vectors have components along the fixed axes. Velocities and accelerations are linear, then angular.
struct Frame {
  std::uint32_t axes = 0;  // index into Model::frames; 0: it does not rotate
  std::array<symbolic::Ref, 3> position;
  std::array<symbolic::Ref, 9> rotation;        // e1, e2, e3
  std::array<symbolic::Ref, 6> velocity, bias;  // velocity: linear in qdot; bias: acceleration at qddot = 0
};

}  // namespace eomgen::system
