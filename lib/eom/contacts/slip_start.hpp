// SPDX-License-Identifier: MIT
// Slip in two directions that has just begun. In: the slip, the direction in which it began, the least slip that has a
// direction. Out: the direction against which friction acts, and whether the start is over.
//
// Slip has no direction at speed 0, and friction changes its direction at the rate mu N / (m slip), which no explicit
// method follows at small slip. A slip that began is therefore led from its first direction, which the laws give, to
// its own. Where the slip grows as c t^2 and its direction turns at the rate k, friction along the slip is wrong by k^2
// t^2 / 2, and the speed by an amount that grows with the power 3/2 of the slip at the end: it is of the size of the
// tolerance if that slip grows with its power 2/3.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace eom::contacts {

/// The slip at which a start ends, as a multiple of the least slip that has a direction.
inline double start_of_slip(double rtol) {
  constexpr double at_least = 2, share = 0.06;
  return std::max(at_least, share / std::cbrt(std::max(rtol, 1e-15)));
}

/// The unit vector of friction for a slip w that began along `began`. least: the least slip that has a direction; end:
/// the slip at which the start ends.
inline std::array<double, 2> friction_direction(const std::array<double, 2>& w, const std::array<double, 2>& began,
                                                double least, double end) {
  const double speed = std::hypot(w[0], w[1]);
  if (speed <= least) return began;
  if (speed >= end) return {w[0] / speed, w[1] / speed};
  const double own = (speed - least) / (end - least);
  const std::array<double, 2> sum{(1 - own) * began[0] + own * w[0] / speed, (1 - own) * began[1] + own * w[1] / speed};
  const double length = std::hypot(sum[0], sum[1]);
  return length > 0 ? std::array<double, 2>{sum[0] / length, sum[1] / length} : began;
}

/// The derivative of the angle of friction_direction() by a change of the slip w, at fixed `began`. It is 0 at slips
/// that have no direction.
inline double friction_angle_derivative(const std::array<double, 2>& w, const std::array<double, 2>& change,
                                        const std::array<double, 2>& began, double least, double end) {
  const double speed = std::hypot(w[0], w[1]);
  if (!(speed > least)) return 0;
  const std::array<double, 2> n{w[0] / speed, w[1] / speed};
  const double along = n[0] * change[0] + n[1] * change[1], turn = (n[0] * change[1] - n[1] * change[0]) / speed;
  if (speed >= end) return turn;
  const double own = (speed - least) / (end - least), own_change = along / (end - least);
  const std::array<double, 2> sum{(1 - own) * began[0] + own * n[0], (1 - own) * began[1] + own * n[1]};
  const double square = sum[0] * sum[0] + sum[1] * sum[1];
  if (!(square > 0)) return 0;
  const std::array<double, 2> change_of_sum{own_change * (n[0] - began[0]) - own * turn * n[1],
                                            own_change * (n[1] - began[1]) + own * turn * n[0]};
  return (sum[0] * change_of_sum[1] - sum[1] * change_of_sum[0]) / square;
}

/// Whether a slip w that began along `began` is large enough to end, or has a direction of its own away from that one.
inline bool has_started(const std::array<double, 2>& w, const std::array<double, 2>& began, double least, double end) {
  const double speed = std::hypot(w[0], w[1]);
  return speed > end || (speed > least && w[0] * began[0] + w[1] * began[1] < 0.5 * speed);
}

}  // namespace eom::contacts
