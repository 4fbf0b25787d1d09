// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/kicks.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

constexpr double inside = 1e-3;   // of the step: at its ends another branch or mode may begin
constexpr double stands_out = 8;  // times as large as around
constexpr double at_rest = 1e-6;  // of the largest velocity: what stays below moves by rounding

}  // namespace

void Kicks::see(const eom::StepView& step, const Derivative& f) {
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
  last.difference.resize(kick_.size());
  for (std::size_t i = 0; i < kick_.size(); ++i) {
    const std::size_t k = first_ + i;
    last.difference[i] = std::abs(start_[k] - 2 * middle_[k] + end_[k]);
    velocity_[i] = std::max({velocity_[i], std::abs(step.x0[k]), std::abs(step.x1[k])});
  }
  ++seen_;
  if (seen_ >= steps_.size())
    look(around, &steps_.front(), &steps_.back());
  else if (seen_ > around)
    look(steps_.size() - 1 - around, nullptr, &steps_.back());  // one of the first: none before it
}

/// The step at `place` among the last ones.
void Kicks::look(std::size_t place, const Step* before, const Step* after) {
  const Step& here = steps_[place];
  for (std::size_t i = 0; i < kick_.size(); ++i) {
    const auto second = [&](const Step* step) {
      return step == nullptr ? 0 : step->difference[i] / (step->h * step->h);
    };
    if (!(second(&here) > stands_out * std::max(second(before), second(after)))) continue;
    if (const double size = here.h * here.difference[i]; size > kick_[i].size) kick_[i] = {size, here.t};
  }
}

void Kicks::finish() {
  for (std::size_t back = 0; back < std::min(around, seen_ > around ? seen_ - around : 0); ++back) {
    const std::size_t place = steps_.size() - 1 - back;
    look(place, &steps_[place - around], nullptr);
  }
}

double Kicks::largest(double& at) const {
  double fastest = 0, largest = 0;
  for (const double v : velocity_) fastest = std::max(fastest, v);
  for (std::size_t i = 0; i < kick_.size(); ++i) {
    if (velocity_[i] <= at_rest * fastest || kick_[i].size <= largest * velocity_[i]) continue;
    largest = kick_[i].size / velocity_[i];
    at = kick_[i].t;
  }
  return largest;
}

}  // namespace eomgen::run
