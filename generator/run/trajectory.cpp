// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eomgen::run {

// A polynomial of the degree of the dense output is given by its values at one node more. Chebyshev's points of the
// second kind have simple weights and contain both ends (Berrut, Trefethen, Barycentric Lagrange Interpolation, SIAM
// Review 46, 2004, eq. 5.4).
Trajectory::Trajectory(std::size_t states, int dense_order, std::size_t budget)
    : n_(states), budget_(budget), x_(states) {
  const auto degree = static_cast<std::size_t>(std::max(1, dense_order));
  for (std::size_t k = 0; k <= degree; ++k) {
    const double angle = std::numbers::pi * static_cast<double>(k) / static_cast<double>(degree);
    places_.push_back((1 - std::cos(angle)) / 2);
    weights_.push_back((k % 2 == 0 ? 1 : -1) * (k == 0 || k == degree ? 0.5 : 1.0));
  }
  places_.back() = 1;
}

void Trajectory::begin(double t, std::span<const double> x) { parts_.push_back({t, t, {x.begin(), x.end()}}); }

void Trajectory::add(const eom::StepView& step) {
  if (parts_.back().ends.size() >= longest_part) begin(step.t0, step.x0);
  append(parts_.back(), step);
  for (; stored_ > budget_ && oldest_ + 1 < parts_.size(); ++oldest_) release(oldest_);
}

void Trajectory::restart(std::size_t k) {
  release(k);
  parts_[k].ends.clear();
}

void Trajectory::add_to(std::size_t k, const eom::StepView& step) { append(parts_[k], step); }

void Trajectory::release(std::size_t k) {
  stored_ -= parts_[k].nodes.size() * sizeof(double);
  parts_[k].nodes = {};
}

void Trajectory::append(Part& part, const eom::StepView& step) {
  if (part.ends.empty()) part.first_step = step.t1 - step.t0;
  part.ends.push_back(step.t1);
  part.t1 = step.t1;
  part.nodes.insert(part.nodes.end(), step.x0.begin(), step.x0.begin() + static_cast<std::ptrdiff_t>(n_));
  for (std::size_t k = 1; k + 1 < places_.size(); ++k) {
    step.interpolate(step.t0 + places_[k] * (step.t1 - step.t0), x_);
    part.nodes.insert(part.nodes.end(), x_.begin(), x_.end());
  }
  part.nodes.insert(part.nodes.end(), step.x1.begin(), step.x1.begin() + static_cast<std::ptrdiff_t>(n_));
  stored_ += places_.size() * n_ * sizeof(double);
}

void Trajectory::state(std::size_t k, double t, double* x) const {
  const Part& part = parts_[k];
  const auto end = std::lower_bound(part.ends.begin(), part.ends.end(), t);
  const std::size_t step =
      std::min<std::size_t>(static_cast<std::size_t>(end - part.ends.begin()), part.ends.size() - 1);
  const double begin = step == 0 ? part.t0 : part.ends[step - 1], place = (t - begin) / (part.ends[step] - begin);
  const double* const nodes = part.nodes.data() + step * places_.size() * n_;
  double sum = 0;
  std::fill(x, x + n_, 0.0);
  for (std::size_t j = 0; j < places_.size(); ++j) {
    const double* const at = nodes + j * n_;
    if (place == places_[j]) {
      std::copy(at, at + n_, x);
      return;
    }
    const double weight = weights_[j] / (place - places_[j]);
    sum += weight;
    for (std::size_t i = 0; i < n_; ++i) x[i] += weight * at[i];
  }
  for (std::size_t i = 0; i < n_; ++i) x[i] /= sum;
}

}  // namespace eomgen::run
