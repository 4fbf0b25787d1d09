// SPDX-License-Identifier: GPL-3.0-or-later
// Forces and moments of potentials on rigid bodies: F = -sum dU/dx_i a^i, M = -sum dU/dnu_i g^i with the dual Euler
// basis, eqs. (5.83), (8.80). In: Mechanics. Out: both vectors for each force with a potential and each body.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reading/kinematics.hpp"

namespace eomgen::reading {

/// The vector -sum dU/dq_i times the vector dual to q_i, and its components along axes.
struct PotentialVector {
  std::vector<std::pair<std::uint32_t, Sum>> along_dual;  // coordinate, -dU/dq; entries that are not 0
  Axes axes;
  Components components;
};

struct BodyForce {
  std::string force, body;  // names
  std::uint32_t index = 0;  // of the body
  bool along_fixed = true;  // F along E1, E2, E3, whose coordinates are those of the body; else along a^i
  PotentialVector force_vector, moment;
  std::string skip_reason;  // why the vectors are omitted; empty if they are present
};

/// Zero vectors are omitted, and so are forces that act on a body in no way.
std::vector<BodyForce> body_forces(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
