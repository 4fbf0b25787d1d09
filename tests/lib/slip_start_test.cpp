// SPDX-License-Identifier: MIT
// The direction of friction while slip begins, and its derivative.
#include "eom/contacts/slip_start.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

namespace {

using Slip = std::array<double, 2>;

constexpr double least_slip = 0.1, end_of_start = 1.1;

/// The derivative of the angle of friction_direction() by a change of w, by central differences of order four.
double turn_by_differences(const Slip& w, const Slip& change, const Slip& began) {
  const auto angle_at = [&](double h) {
    const Slip n = eom::contacts::friction_direction(w, began, least_slip, end_of_start);
    const Slip m = eom::contacts::friction_direction({w[0] + h * change[0], w[1] + h * change[1]}, began, least_slip,
                                                     end_of_start);
    return std::atan2(n[0] * m[1] - n[1] * m[0], n[0] * m[0] + n[1] * m[1]);
  };
  constexpr double h = 1e-3;
  return (8 * (angle_at(h) - angle_at(-h)) - (angle_at(2 * h) - angle_at(-2 * h))) / (12 * h);
}

}  // namespace

TEST_CASE("the derivative of the direction of friction agrees with differences") {
  const Slip began{0.6, 0.8};
  for (const double speed : {0.15, 0.4, 0.9, 1.05, 1.5})
    for (const double angle : {-1.0, 0.2, 0.9, 2.5})
      for (const Slip& change : {Slip{1, 0}, Slip{0, 1}, Slip{-0.3, 0.7}}) {
        const Slip w{speed * std::cos(angle), speed * std::sin(angle)};
        CAPTURE(speed);
        CAPTURE(angle);
        const double expected = turn_by_differences(w, change, began);
        const double turn = eom::contacts::friction_angle_derivative(w, change, began, least_slip, end_of_start);
        // The truncation of the differences: h^4 times derivatives of order five, of the size 1/speed^5.
        CHECK(turn == doctest::Approx(expected).epsilon(1e-6).scale(1));
      }
}

TEST_CASE("slip without a direction of its own does not turn friction") {
  CHECK(eom::contacts::friction_angle_derivative({0.05, 0.05}, {1, 0}, {0.6, 0.8}, least_slip, end_of_start) == 0);
}

TEST_CASE("slip that began earlier turns friction at its own rate") {
  const Slip w{0.3, 0.4}, change{-0.4, 0.3};  // perpendicular to w, as long as w
  CHECK(eom::contacts::friction_angle_derivative(w, change, {1, 0}, least_slip, least_slip) ==
        doctest::Approx(1).epsilon(1e-15));
}
