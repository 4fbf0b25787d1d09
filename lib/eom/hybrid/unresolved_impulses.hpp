// SPDX-License-Identifier: MIT
// Detection of forces that turn within one step. A particle that passes a centre at a small distance receives most of
// its impulse in a time shorter than fixed steps. The end of the run then depends on the position of the passage within
// the step, and runs with different steps may agree by chance. In: the steps of a run and its right-hand side. Out: the
// largest such impulse, relative to the velocity that it changes.
//
// The second difference of the acceleration over a step, divided by h^2, is its second derivative if the steps resolve
// the motion, and changes little over two steps. If it stands out among those of the second steps before and after, the
// force changed within that step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "eom/run_types.hpp"

namespace eom::hybrid {

class UnresolvedImpulses {
 public:
  /// f(t, x, dx): returns a code, or 0; first, count: range of the velocities in the state.
  using Derivative = std::function<int(double t, const double* x, double* dx)>;
  UnresolvedImpulses(std::size_t first, std::size_t count) : first_(first), largest_(count), velocity_(count) {}

  /// Costs three evaluations.
  void observe_step(const StepView& step, const Derivative& f);
  /// To be called after the last step.
  void finish();
  std::size_t evaluations() const { return evaluations_; }

  /// 0 if no acceleration stands out in one step. `at`: the time of the largest impulse.
  double largest(double& at) const;

 private:
  static constexpr double inside = 1e-3;   // of the step: another branch or mode may begin at its ends
  static constexpr double stands_out = 8;  // ratio to the neighbouring steps
  static constexpr double at_rest = 1e-6;  // of the largest velocity: smaller velocities are rounding

  static constexpr std::size_t around = 2;  // steps before and after
  struct Step {
    double t = 0, h = 0;
    std::vector<double> difference;
  };
  struct Largest {
    double size = 0, t = 0;
  };
  void examine_step(std::size_t place, const Step* before, const Step* after);

  std::size_t first_, evaluations_ = 0;
  std::array<Step, 2 * around + 1> steps_;  // the last ones, the oldest first
  std::size_t seen_ = 0;
  std::vector<Largest> largest_;
  std::vector<double> velocity_;  // largest of each
  std::vector<double> x_, start_, middle_, end_;
};

inline void UnresolvedImpulses::observe_step(const StepView& step, const Derivative& f) {
  const double h = step.t1 - step.t0;
  x_.resize(step.x0.size());
  const auto at = [&](double part, std::vector<double>& dx) {
    dx.resize(x_.size());
    step.interpolate(step.t0 + part * h, x_);
    ++evaluations_;
    return f(step.t0 + part * h, x_.data(), dx.data()) == 0;
  };
  if (!at(inside, start_) || !at(0.5, middle_) || !at(1 - inside, end_)) return;
  std::rotate(steps_.begin(), steps_.begin() + 1, steps_.end());
  Step& last = steps_.back();
  last.t = step.t0;
  last.h = std::abs(h);
  last.difference.resize(largest_.size());
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    const std::size_t k = first_ + i;
    last.difference[i] = std::abs(start_[k] - 2 * middle_[k] + end_[k]);
    velocity_[i] = std::max({velocity_[i], std::abs(step.x0[k]), std::abs(step.x1[k])});
  }
  ++seen_;
  if (seen_ >= steps_.size())
    examine_step(around, &steps_.front(), &steps_.back());
  else if (seen_ > around)
    examine_step(steps_.size() - 1 - around, nullptr, &steps_.back());  // one of the first steps: none before it
}

/// Examines the step at `place` among the last ones.
inline void UnresolvedImpulses::examine_step(std::size_t place, const Step* before, const Step* after) {
  const Step& here = steps_[place];
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    const auto second = [&](const Step* step) {
      return step == nullptr ? 0 : step->difference[i] / (step->h * step->h);
    };
    if (!(second(&here) > stands_out * std::max(second(before), second(after)))) continue;
    if (const double size = here.h * here.difference[i]; size > largest_[i].size) largest_[i] = {size, here.t};
  }
}

inline void UnresolvedImpulses::finish() {
  for (std::size_t back = 0; back < std::min(around, seen_ > around ? seen_ - around : 0); ++back) {
    const std::size_t place = steps_.size() - 1 - back;
    examine_step(place, &steps_[place - around], nullptr);
  }
}

inline double UnresolvedImpulses::largest(double& at) const {
  double fastest = 0, largest = 0;
  for (const double v : velocity_) fastest = std::max(fastest, v);
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    if (velocity_[i] <= at_rest * fastest || largest_[i].size <= largest * velocity_[i]) continue;
    largest = largest_[i].size / velocity_[i];
    at = largest_[i].t;
  }
  return largest;
}

}  // namespace eom::hybrid
