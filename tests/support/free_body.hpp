// SPDX-License-Identifier: GPL-3.0-or-later
// The free rigid body with moments J1 < J2 < J3: its angular velocity in closed form.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "support/elliptic.hpp"

namespace eomgen::test {

/// w along the body's axes from w2 = 0, w1 > 0, w3 > 0, if w circles the axis of the largest moment.
inline std::array<double, 3> free_body(const std::array<double, 3>& J, double w1, double w3, double t) {
  const double E2 = J[0] * w1 * w1 + J[2] * w3 * w3, h2 = J[0] * J[0] * w1 * w1 + J[2] * J[2] * w3 * w3;
  const double rate = std::sqrt((J[2] - J[1]) * (h2 - E2 * J[0]) / (J[0] * J[1] * J[2]));
  const double k = std::sqrt((J[1] - J[0]) * (E2 * J[2] - h2) / ((J[2] - J[1]) * (h2 - E2 * J[0])));
  REQUIRE(k < 1);
  const Jacobi s = jacobi(rate * t, k);
  return {w1 * s.cn, std::sqrt((E2 * J[2] - h2) / (J[1] * (J[2] - J[1]))) * s.sn, w3 * s.dn};
}

}  // namespace eomgen::test
