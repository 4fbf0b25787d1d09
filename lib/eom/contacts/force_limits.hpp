// SPDX-License-Identifier: MIT
// The members of ContactForces that find admissible forces. In: the unit forces of the closed contacts with their
// responses, a solution. Out: a solution in which contacts press and friction is within its limits, if there is one.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "eom/contacts/contact_forces.hpp"

namespace eom::contacts {

inline void ContactForces::make_admissible(Vector& forces, ForceChoice choice) {
  if (choice == ForceChoice::any) return;
  write_limits();
  if (least_margin(limits_, forces) >= wanted_margin) return;  // most often
  const double largest = *std::max_element(force_size_.begin(), force_size_.end());
  const double error = margin_error(limits_);
  if (choice == ForceChoice::admissible && preload_.size() == forces.size() && remove_effect(preload_)) {
    // Where limits leave little room, half of what the last search found is enough, and all within its error.
    const double enough = std::min(wanted_margin, std::max(preload_margin_ / 2, -error));
    const Vector preloaded = forces + preload_;
    const double margin = least_margin(limits_, preloaded);
    if (margin >= enough) {
      if (margin < wanted_margin) choice_error_ = error * largest;
      forces = preloaded;
      return;
    }
  }
  AdmissibleForces found(forces, forces_without_effect(responses_), limits_);
  const Vector chosen = found.find();
  choice_error_ = error * largest;
  preload_ = found.best() - forces;
  preload_margin_ = least_margin(limits_, found.best());
  forces = chosen;
}

inline void ContactForces::write_limits() {
  constexpr double least_share = 1e-3;  // nothing but other contacts may press on a contact
  limits_.clear();
  const double largest = *std::max_element(force_size_.begin(), force_size_.end());
  for (std::size_t k = 0; k < patterns_.size();) {
    const std::size_t j = patterns_[k].contact;
    const Description& at = contact(j);
    ForceLimit limit;
    for (; k < patterns_.size() && patterns_[k].contact == j; ++k) {
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
    limit.size = std::max(force_size_[j], least_share * largest);
    // A contact whose normal force is that of another one (a stop on which friction acts) has no limit of its own.
    if (limit.holds && limit.normal < 0 && at.has_constraint()) continue;
    if (limit.size > 0) limits_.push_back(limit);
  }
}

inline bool ContactForces::remove_effect(Vector& forces) {
  constexpr int most = 10;
  constexpr double slow = 0.1, rounding = 1e-15;
  const Vector columns = responses_.colwise().norm().transpose();
  const Vector scales = columns.unaryExpr([](double length) { return length > 0 ? 1 / length : 1.0; });
  for (const bool is_new : {false, true}) {
    if (is_new || effect_inverse_.rows() != forces.size()) {
      Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
      decomposition.setThreshold(effect_tolerance);
      decomposition.compute(responses_ * scales.asDiagonal());
      effect_inverse_ = decomposition.pseudoInverse();
    }
    Vector trial = forces;
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most; ++round) {
      const Vector step = scales.cwiseProduct(effect_inverse_ * (responses_ * trial));
      const double size = step.cwiseQuotient(scales).lpNorm<Eigen::Infinity>();
      if (!(size <= slow * before)) break;
      trial -= step;
      before = size;
      if (size <= rounding * trial.cwiseQuotient(scales).lpNorm<Eigen::Infinity>()) {
        forces = trial;
        return true;
      }
    }
  }
  return false;
}

}  // namespace eom::contacts
