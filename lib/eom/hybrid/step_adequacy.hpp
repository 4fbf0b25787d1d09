// SPDX-License-Identifier: MIT
// Test whether steps of a fixed size resolve a motion. If they do not, runs with different steps may still end alike: a
// method that damps an unresolved motion damps it in all of them. Therefore the states on the way are compared as well.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "eom/run_types.hpp"

namespace eom::hybrid {

class StepAdequacy {
 public:
  /// impacts: a difference counts only if two consecutive states have it, since a single one may lie between two times
  /// of the same impact.
  explicit StepAdequacy(bool impacts) : impacts_(impacts) {}

  /// Records some states of the run itself.
  void observe_step(const StepView& step);

  /// Compares a run with other steps. `align` may change angles of the second state by whole turns.
  using Align = std::function<void(const std::vector<double>& first, std::vector<double>& other)>;
  void compare(const StepView& step, const Align& align);

  /// Largest difference relative to the largest value of its component, and per component.
  double largest() const;
  const std::vector<double>& differences() const { return difference_; }

  /// At a tenth of the moving quantities the end is no longer conclusive.
  static constexpr double unresolved = 0.1;

 private:
  static constexpr std::size_t most = 729;  // stored states
  struct Snapshot {
    double t;
    std::vector<double> x;
  };
  bool impacts_;
  std::vector<Snapshot> snapshots_;
  std::size_t stride_ = 1, steps_ = 0, next_ = 0;
  std::vector<double> size_, difference_, before_, x_;
};

inline void StepAdequacy::observe_step(const StepView& step) {
  size_.resize(step.x1.size());
  difference_.resize(step.x1.size());
  for (std::size_t i = 0; i < step.x1.size(); ++i)
    size_[i] = std::max({size_[i], std::abs(step.x0[i]), std::abs(step.x1[i])});
  if (++steps_ % stride_ != 0) return;
  snapshots_.push_back({step.t1, {step.x1.begin(), step.x1.end()}});
  if (snapshots_.size() < most) return;
  // Every third state is kept. With every second one, a state that changes its sign in each step would show no
  // difference.
  for (std::size_t i = 0; 3 * i + 2 < snapshots_.size(); ++i) std::swap(snapshots_[i], snapshots_[3 * i + 2]);
  snapshots_.resize(snapshots_.size() / 3);
  stride_ *= 3;
}

inline void StepAdequacy::compare(const StepView& step, const Align& align) {
  for (; next_ < snapshots_.size() && snapshots_[next_].t <= step.t1; ++next_) {
    const Snapshot& seen = snapshots_[next_];
    if (seen.t < step.t0) continue;
    x_.resize(step.x1.size());
    if (seen.t == step.t1)
      x_.assign(step.x1.begin(), step.x1.end());
    else
      step.interpolate(seen.t, x_);
    align(seen.x, x_);
    before_.resize(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double now = std::abs(x_[i] - seen.x[i]);
      difference_[i] = std::max(difference_[i], impacts_ ? std::min(now, before_[i]) : now);
      before_[i] = now;
    }
  }
}

inline double StepAdequacy::largest() const {
  double largest = 0, size = 0;
  for (const double s : size_) size = std::max(size, s);
  for (std::size_t i = 0; i < difference_.size(); ++i) {
    const double s = std::max(size_[i], 1e-9 * size);  // components that stay 0 are 0 to rounding
    if (s > 0) largest = std::max(largest, difference_[i] / s);
  }
  return largest;
}

}  // namespace eom::hybrid
