// SPDX-License-Identifier: MIT
// Drift of invariants, and the power balance, along a run. In: values at the observed times. Out: the largest
// deviations.
//
// Drift of a quantity v that should stay at v0:
//   max_abs_drift      = max_t |v(t) - v0|
//   max_relative_drift = max_abs_drift / scale,  scale = max(|v0|, largest magnitude passed)
// The magnitude is the size of the terms whose sum is v (for an energy: T + |U|). If v0 is zero or small by
// cancellation, rounding is therefore not reported as a drift. If the scale is 0 (v0 is 0 and no magnitude was passed),
// max_relative_drift is max_abs_drift, in the units of v.
//
// Power balance of the energy E and the work W since the start of the forces that are not part of E:
//   max_abs_defect      = max_t |E(t) - E(0) - W(t)|
//   max_relative_defect = max_abs_defect / scale,  scale = max over t of |E|, |W| and the magnitude passed;
// if the scale is 0, max_abs_defect. A value that is not finite makes the drift infinite for the rest of the run.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace eom {

namespace detail {

inline double distance(double a, double b) {
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

/// value / scale; value if the scale is 0; infinite if either is not finite.
inline double relative_to(double value, double scale) {
  if (!std::isfinite(value) || !std::isfinite(scale)) return std::numeric_limits<double>::infinity();
  return scale > 0 ? value / scale : value;
}

}  // namespace detail

/// One quantity that should stay constant.
class Drift {
 public:
  /// `name`: of the quantity, for reports.
  explicit Drift(std::string name) : name_(std::move(name)) {}

  /// Adds a value, in order of time; the first one is the initial value. magnitude: size of the terms whose sum it is.
  void observe(double value, double magnitude = 0) {
    if (!started_) initial_ = value;
    started_ = true;
    scale_ = std::max({scale_, std::abs(initial_), std::abs(magnitude)});
    max_abs_drift_ = std::max(max_abs_drift_, detail::distance(value, initial_));
  }

  /// The name of the quantity.
  const std::string& name() const { return name_; }
  /// v0, the first value.
  double initial() const { return initial_; }
  /// max_t |v(t) - v0|, in the units of v.
  double max_abs_drift() const { return max_abs_drift_; }
  /// The same divided by the scale of v.
  double max_relative_drift() const { return detail::relative_to(max_abs_drift_, scale_); }

 private:
  std::string name_;
  bool started_ = false;
  double initial_ = 0;
  double scale_ = 0;
  double max_abs_drift_ = 0;
};

/// Balance of the energy and the work of forces that are not part of the energy.
class PowerBalance {
 public:
  /// Adds values, in order of time. energy_magnitude: for example T + |U|, if E = T + U cancels.
  void observe(double energy, double work, double energy_magnitude = 0) {
    if (!started_) offset_ = energy - work;
    started_ = true;
    scale_ = std::max({scale_, std::abs(energy), std::abs(work), std::abs(energy_magnitude)});
    max_abs_defect_ = std::max(max_abs_defect_, detail::distance(energy - work, offset_));
  }

  /// max_t |E(t) - E(0) - W(t)|, in the units of the energy.
  double max_abs_defect() const { return max_abs_defect_; }
  /// The same divided by the scale of the energies.
  double max_relative_defect() const { return detail::relative_to(max_abs_defect_, scale_); }

 private:
  bool started_ = false;
  double offset_ = 0;
  double scale_ = 0;
  double max_abs_defect_ = 0;
};

}  // namespace eom
