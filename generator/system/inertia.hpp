// SPDX-License-Identifier: GPL-3.0-or-later
// The masses and inertia tensors of bodies and particles, as Dag expressions like those of an EquationSystem.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::system {

/// A rotating body. Components are along its own axes.
struct BodyInertia {
  std::array<symbolic::Ref, 6> tensor;      // about its place: 11, 12, 13, 22, 23, 33
  std::array<symbolic::Ref, 3> spin, bias;  // angular velocity; angular acceleration at qddot = 0
};

/// A particle or a body.
struct Inertia {
  std::size_t frame = 0;  // its motion: index into the list of Frame
  symbolic::Ref mass;
  std::optional<BodyInertia> body;
};

struct Inertias {
  std::vector<Inertia> of;
  std::array<symbolic::Ref, 3> gravity;  // uniform, along the fixed axes; unset without entries of `of`
};

}  // namespace eomgen::system
