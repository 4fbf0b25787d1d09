// SPDX-License-Identifier: MIT
// Invariants and the power balance, watched along a run. In: values at the observed times. Out: how far they drifted.
//
// Drift of a quantity v that should stay at v0:
//   max_abs_drift      = max_t |v(t) - v0|
//   max_relative_drift = max_abs_drift / scale,  scale = max(|v0|, largest magnitude handed over)
// where a magnitude is the size of the terms whose sum v is (for an energy: T + |U|), so that a v0 that is zero or
// small by cancellation does not make rounding look like a defect. Where the scale is 0 (v0 is 0 and no magnitude was
// given) max_relative_drift is max_abs_drift itself, in the units of v.
//
// Power balance of the energy E and the work W done since the start by what is not in E:
//   max_abs_defect      = max_t |E(t) - E(0) - W(t)|
//   max_relative_defect = max_abs_defect / scale,  scale = max over t of |E|, |W| and the magnitude handed over;
// where the scale is 0, max_abs_defect itself. Values that are not finite make the drift infinite; it never shrinks
// back.
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

/// value / scale; the value itself where the scale is 0, infinite where either is not finite.
inline double relative_to(double value, double scale) {
  if (!std::isfinite(value) || !std::isfinite(scale)) return std::numeric_limits<double>::infinity();
  return scale > 0 ? value / scale : value;
}

}  // namespace detail

/// One quantity that should stay constant.
class Drift {
 public:
  explicit Drift(std::string name) : name_(std::move(name)) {}

  /// A value in order of time, the first one the initial; magnitude: size of the terms that it is the sum of.
  void see(double value, double magnitude = 0) {
    if (!started_) initial_ = value;
    started_ = true;
    scale_ = std::max({scale_, std::abs(initial_), std::abs(magnitude)});
    max_abs_drift_ = std::max(max_abs_drift_, detail::distance(value, initial_));
  }

  const std::string& name() const { return name_; }
  double initial() const { return initial_; }
  double max_abs_drift() const { return max_abs_drift_; }
  double max_relative_drift() const { return detail::relative_to(max_abs_drift_, scale_); }

 private:
  std::string name_;
  bool started_ = false;
  double initial_ = 0;
  double scale_ = 0;
  double max_abs_drift_ = 0;
};

/// Energy against the work of what is not in the energy.
class PowerBalance {
 public:
  /// Values in order of time; energy_magnitude: T + |U|, say, where E = T + U cancels.
  void see(double energy, double work, double energy_magnitude = 0) {
    if (!started_) offset_ = energy - work;
    started_ = true;
    scale_ = std::max({scale_, std::abs(energy), std::abs(work), std::abs(energy_magnitude)});
    max_abs_defect_ = std::max(max_abs_defect_, detail::distance(energy - work, offset_));
  }

  double max_abs_defect() const { return max_abs_defect_; }
  double max_relative_defect() const { return detail::relative_to(max_abs_defect_, scale_); }

 private:
  bool started_ = false;
  double offset_ = 0;
  double scale_ = 0;
  double max_abs_defect_ = 0;
};

}  // namespace eom
