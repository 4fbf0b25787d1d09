// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle's motions of places and axes at a state, along the fixed axes: coefficients of jets along the path and
// along each coordinate of the model.
#pragma once

#include <array>
#include <vector>

#include "oracle/dalembert.hpp"

namespace eomgen::verify {

using Components = std::array<Real, 3>;

inline Real largest_of(const Components& v) {
  return cln::max(cln::max(cln::abs(v[0]), cln::abs(v[1])), cln::abs(v[2]));
}
inline Components cross_product(const Components& a, const Components& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct PlaceMotion {
  Components position, velocity, acceleration;
  std::vector<Components> tangent;  // dr/dq_i
};

struct AxesMotion {
  std::array<Components, 3> e;
  Components velocity, acceleration;  // angular
  std::vector<Components> rotation;   // the rotation with q_i
};

/// Of Model::places[index].
PlaceMotion place_motion(Interpreter& at, std::uint32_t index, std::size_t coordinates);
/// Of Model::frames[index].
AxesMotion axes_motion(Interpreter& at, std::uint32_t index, std::size_t coordinates);

}  // namespace eomgen::verify
