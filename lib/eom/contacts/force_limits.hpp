// SPDX-License-Identifier: MIT
// The member of ContactForces that finds admissible forces. In: the unit forces of the closed contacts with their
// responses, a solution. Out: a solution in which contacts press and friction is within its limits, if there is one.
#pragma once

#include "eom/contacts/contact_forces.hpp"

namespace eom::contacts {

inline void ContactForces::make_admissible(Vector& forces) const {
  std::vector<ForceLimit> limits(set_.contacts.size());
  std::vector<bool> used(set_.contacts.size(), false);
  for (std::size_t k = 0; k < patterns_.size(); ++k) {
    const std::size_t j = patterns_[k].contact;
    const Description& at = contact(j);
    ForceLimit& limit = limits[j];
    used[j] = true;
    if (patterns_[k].component < 0) {
      limit.normal = static_cast<Index>(k);
      limit.scale = c_[at.normal_scale] * (at.unilateral ? 1 : states_[j].normal_sign);
    } else if (limit.tangents++ == 0) {
      limit.holds = true;
      limit.tangent = static_cast<Index>(k);
      limit.coefficient = c_[at.static_coefficient];
      if (!at.has_constraint()) limit.given = std::abs(c_[at.given_normal]);
    }
  }
  double largest = 0;
  for (std::size_t j = 0; j < limits.size(); ++j) largest = std::max(largest, force_size_[j]);
  std::vector<ForceLimit> all;
  for (std::size_t j = 0; j < limits.size(); ++j) {
    if (!used[j]) continue;
    limits[j].size = force_size_[j] > 0 ? force_size_[j] : largest;
    // A contact whose normal force is that of another one (a stop on which friction acts) has no limit of its own.
    if (limits[j].holds && limits[j].normal < 0 && contact(j).has_constraint()) continue;
    if (limits[j].size > 0) all.push_back(limits[j]);
  }
  if (least_margin(all, forces) >= wanted_margin) return;  // most often
  forces = AdmissibleForces(forces, forces_without_effect(responses_), all).find();
}

}  // namespace eom::contacts
