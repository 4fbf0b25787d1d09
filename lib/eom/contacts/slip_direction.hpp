// SPDX-License-Identifier: MIT
// The member of ContactForces that gives directions of slip. In: the rows of a contact at a state. Out: the direction
// against which friction acts.
//
// Slip in two directions has none at speed 0, and friction changes its direction at the rate mu N / (m slip). A slip
// that began is led from the direction in which it began, which the laws give, to its own.
#pragma once

#include "eom/contacts/contact_forces.hpp"

namespace eom::contacts {

inline std::array<double, 2> ContactForces::direction(std::size_t j) const {
  const Description& at = contact(j);
  std::array<double, 2> w{};
  for (std::size_t a = 0; a < at.slip.size(); ++a) w[a] = rate(at.slip[a]);
  if (at.width != none) {
    const double size = std::sqrt(w[0] * w[0] + w[1] * w[1] + c_[at.width] * c_[at.width]);
    if (size == 0) return {};  // a slip that constraints prescribe has no width
    return {w[0] / size, w[1] / size};
  }
  if (at.slip.size() == 1) return {states_[j].mode == Mode::sliding_back ? -1.0 : 1.0, 0};
  const double speed = slip_speed(j);
  const std::array<double, 2>& began = states_[j].direction;
  if (speed <= least_slip_) return began;
  if (!states_[j].starts || speed >= start_slip_) return {w[0] / speed, w[1] / speed};
  const double own = (speed - least_slip_) / (start_slip_ - least_slip_);
  const std::array<double, 2> sum{(1 - own) * began[0] + own * w[0] / speed, (1 - own) * began[1] + own * w[1] / speed};
  const double length = std::hypot(sum[0], sum[1]);
  return length > 0 ? std::array<double, 2>{sum[0] / length, sum[1] / length} : began;
}

}  // namespace eom::contacts
