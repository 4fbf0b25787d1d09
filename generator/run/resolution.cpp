// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/resolution.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {

void Resolution::see(const eom::StepView& step) {
  size_.resize(step.x1.size());
  difference_.resize(step.x1.size());
  for (std::size_t i = 0; i < step.x1.size(); ++i)
    size_[i] = std::max({size_[i], std::abs(step.x0[i]), std::abs(step.x1[i])});
  if (++steps_ % stride_ != 0) return;
  seen_.push_back({step.t1, {step.x1.begin(), step.x1.end()}});
  if (seen_.size() < most) return;
  // Every third one stays: of every other one a state that changes its sign with each step would show nothing.
  for (std::size_t i = 0; 3 * i + 2 < seen_.size(); ++i) std::swap(seen_[i], seen_[3 * i + 2]);
  seen_.resize(seen_.size() / 3);
  stride_ *= 3;
}

void Resolution::compare(const eom::StepView& step, const Align& align) {
  for (; next_ < seen_.size() && seen_[next_].t <= step.t1; ++next_) {
    const Seen& seen = seen_[next_];
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

double Resolution::largest() const {
  double largest = 0, size = 0;
  for (const double s : size_) size = std::max(size, s);
  for (std::size_t i = 0; i < difference_.size(); ++i) {
    const double s = std::max(size_[i], 1e-9 * size);  // what stays 0 beside the others is 0 to their rounding
    if (s > 0) largest = std::max(largest, difference_[i] / s);
  }
  return largest;
}

}  // namespace eomgen::run
