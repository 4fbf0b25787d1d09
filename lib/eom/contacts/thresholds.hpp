// SPDX-License-Identifier: MIT
// Values that count as zero at contacts: rounding errors, and errors of the run, are no events. In: the states of a
// run. Out: the errors of gaps, speeds and forces, from the largest terms that were seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "eom/contacts/contact_forces.hpp"

namespace eom::contacts {

/// Bounds below which values count as zero in one decision.
struct Tolerances {
  double speed = 1e-12;  // of gaps and slip
  double slip = 1e-12;   // in two directions
  double error = 0;      // of speeds, left by the errors of faster motion
};

/// Bounds below which a gap or a speed counts as zero, from the sizes met during the run.
class Thresholds {
 public:
  /// Sizes since the start of a run. Terms: the sums of the absolute values of the terms of a gap.
  struct Sizes {
    double speed = 0;
    std::vector<double> gap = {}, terms = {}, force = {};  // per contact; gaps of open ones
    std::vector<double> flight = {};                       // per contact: its largest gap since it opened
  };

  /// `forces` must outlive this object.
  Thresholds(const ContactForces& forces, std::size_t coordinates, double rtol, double atol)
      : forces_(forces), n_(coordinates), rtol_(rtol), atol_(atol) {
    start();
  }

  /// Forgets all sizes.
  void start() {
    const std::vector<double> zeros(forces_.set().contacts.size(), 0.0);
    sizes_ = {0, zeros, zeros, zeros, zeros};
  }
  /// rtol and atol of the run.
  void set_tolerances(double rtol, double atol) { rtol_ = rtol, atol_ = atol; }
  /// The sizes so far.
  const Sizes& sizes() const { return sizes_; }
  /// Restores the sizes.
  void restore(const Sizes& from) { sizes_ = from; }

  /// The rows of the forces are evaluated at the state x. Contacts with `skipped` are left out.
  void observe(const double* x, const std::vector<bool>& skipped = {}) {
    for (std::size_t j = 0; j < sizes_.gap.size(); ++j)
      if (j >= skipped.size() || !skipped[j]) observe_contact(j, x);
  }
  /// Of contact j alone.
  void observe_contact(std::size_t j, const double* x) {
    const Description& at = forces_.contact(j);
    const auto observe_speed = [&](const Row& row) { grow(sizes_.speed, forces_.terms(row, x + n_)); };
    if (at.has_constraint()) {
      observe_speed(at.normal);
      grow(sizes_.terms[j], forces_.terms(at.normal, x));
    }
    for (const Row& row : at.slip) observe_speed(row);
    if (!at.unilateral) return;
    if (forces_.is_closed(j)) {
      sizes_.flight[j] = 0;
    } else {
      grow(sizes_.gap[j], forces_.value(at.gap));
      grow(sizes_.flight[j], forces_.value(at.gap));
    }
  }
  /// The forces are solved for.
  void observe_force(std::size_t j) { grow(sizes_.force[j], forces_.force_size(j)); }

  double negligible_speed() const {
    constexpr double rounding = 1e-15, share = 1e-3, roundings = 1e-14;
    return std::max({rounding, atol_, std::max(share * rtol_, roundings) * sizes_.speed});
  }
  double speed_rounding() const { return 1e-14 * sizes_.speed; }
  double force_rounding(std::size_t j) const {
    return std::max({1e-11 * sizes_.force[j], forces_.acceleration_rounding() * forces_.force_per_acceleration(j),
                     forces_.choice_error()});
  }
  double gap_rounding(std::size_t j, const double* x) const {
    constexpr double roundings = 16, of_gaps = 3e-14;
    const double terms = std::max(sizes_.terms[j], forces_.terms(forces_.contact(j).normal, x));
    return std::max(roundings * std::numeric_limits<double>::epsilon() * terms, of_gaps * sizes_.gap[j]);
  }
  /// Whether open contact i meets when contact j does, but for errors of the run: two points of a body that falls flat.
  /// Both have come from the same height, far beyond these errors.
  bool meets_with(std::size_t i, std::size_t j, const double* x) const {
    constexpr double high = 1e3, alike = 0.01;
    const Row& normal = forces_.contact(i).normal;
    double known = 0;
    for (std::size_t k = 0; k < normal.columns.size(); ++k)
      known += std::abs(forces_.value(normal.slope(k))) * (atol_ + rtol_ * std::abs(x[normal.columns[k]]));
    const double height = sizes_.flight[i];
    return forces_.value(forces_.contact(i).gap) <= known && height > high * known &&
           std::abs(height - sizes_.flight[j]) <= alike * height;
  }
  /// Bounces up to this height are none. Rounding lets a contact fall further than it rose: at most as far as the
  /// locator's rounding of a gap. Above this height each rocking or bounce loses more than it gains by that.
  double low_bounce(std::size_t j, const double* x) const {
    constexpr double roundings = 10, of_gaps = 1e-12;
    return std::max(roundings * gap_rounding(j, x), of_gaps * sizes_.gap[j]);
  }
  /// The least slip in two directions whose direction is known at the state x.
  double least_slip(const double* x) const {
    constexpr double tolerances = 30;
    double least = negligible_speed();
    for (std::size_t j = 0; j < sizes_.gap.size(); ++j) {
      if (forces_.contact(j).slip.size() != 2) continue;
      for (const Row& row : forces_.contact(j).slip) {
        double known = 0;
        for (std::size_t k = 0; k < row.columns.size(); ++k)
          known += std::abs(forces_.value(row.slope(k))) * (atol_ + rtol_ * std::abs(x[n_ + row.columns[k]]));
        least = std::max(least, tolerances * known);
      }
    }
    return least;
  }
  /// The slip up to which one that began with a slip of 0 keeps some of the direction in which it began.
  double start_slip(double least) const { return least * start_of_slip(rtol_); }
  Tolerances tolerances() const {
    return {negligible_speed(), std::max(negligible_speed(), forces_.least_slip()), rtol_ * sizes_.speed};
  }

 private:
  static void grow(double& largest, double value) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }

  const ContactForces& forces_;
  std::size_t n_;
  double rtol_, atol_;
  Sizes sizes_;
};

}  // namespace eom::contacts
