// SPDX-License-Identifier: MIT
// The members of ContactForces for friction along the normal of another contact: a coordinate with Coulomb friction on
// its end stop. In: the rows, the forces. Out: the force of the stop in place of friction.
#pragma once

#include "eom/contacts/contact_forces.hpp"

namespace eom::contacts {

inline double ContactForces::ratio(const Row& row, const Row& other) const {
  constexpr double rounding = 1e-12;
  std::size_t largest = 0;
  for (std::size_t k = 1; k < row.columns.size(); ++k)
    if (std::abs(c_[other.slope(k)]) > std::abs(c_[other.slope(largest)])) largest = k;
  if (row.columns.empty() || c_[other.slope(largest)] == 0) return 0;
  const double s = c_[row.slope(largest)] / c_[other.slope(largest)];
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    const double size = std::abs(c_[row.slope(largest)]);
    if (std::abs(c_[row.slope(k)] - s * c_[other.slope(k)]) > rounding * size) return 0;
  }
  return s;
}

inline bool ContactForces::is_prevented_by_sticking(std::size_t j) const {
  return std::any_of(alike_.begin(), alike_.end(), [&](const Alike& pair) {
    return pair.stop == j && !has_friction(j) && is_sticking(pair.sticking) &&
           ratio(*pair.slip, contact(j).normal) != 0;
  });
}

inline void ContactForces::pass_to_stop(double* u, const Pattern& tangent, double force) {
  const Row& row = contact(tangent.contact).slip[static_cast<std::size_t>(tangent.component)];
  for (const Alike& pair : alike_) {
    if (pair.slip != &row || !is_closed(pair.stop) || has_friction(pair.stop)) continue;
    const double lambda = force * ratio(row, contact(pair.stop).normal);
    if (!(lambda > 0)) continue;
    push(u, tangent, -force);
    push(u, normal_pattern(pair.stop, false), lambda);
    lambda_[pair.stop] = lambda;
    force_size_[pair.stop] = std::abs(lambda / force) * force_size_[tangent.contact];
    force_per_acceleration_[pair.stop] = std::abs(lambda / force) * force_per_acceleration_[tangent.contact];
    return;
  }
}

}  // namespace eom::contacts
