// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/singular_passage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eomgen::run {

namespace {

constexpr double near = 0.1;        // of the measure: rank is lost soon, and its decrease is close to linear
constexpr double soon = 0.3;        // from here on it is looked at after every step
constexpr int look_every = 8;       // steps, else
constexpr double redundant = 1e-9;  // below it rows follow from others all the time
constexpr double shorter =
    0.7;  // than the longest step so far: the solver has met something, and it is looked at at once
constexpr double look_ahead = 1e-3;  // of the step, for the slope of the measure

}  // namespace

SingularPassage::SingularPassage(std::size_t n, std::size_t rows, Rows evaluate)
    : n_(n),
      evaluate_(std::move(evaluate)),
      A_(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(n)),
      transposed_(A_.cols(), A_.rows()),
      qr_(A_.cols(), A_.rows()),
      longest_row_(Eigen::VectorXd::Zero(A_.rows())) {}

double SingularPassage::rank_measure(double t, const double* x) {
  if (A_.rows() == 0 || A_.rows() > A_.cols() || evaluate_(t, x, A_.data()) != 0 || !A_.allFinite())
    return std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index i = 0; i < A_.rows(); ++i) {
    longest_row_(i) = std::max(longest_row_(i), A_.row(i).norm());  // a row may vanish, as where bars lie flat
    transposed_.col(i) = A_.row(i).transpose() / (longest_row_(i) > 0 ? longest_row_(i) : 1);
  }
  qr_.compute(transposed_);
  row_ = static_cast<std::size_t>(qr_.colsPermutation().indices()(A_.rows() - 1));
  return std::abs(qr_.matrixQR()(A_.rows() - 1, A_.rows() - 1)) / std::max(qr_.maxPivot(), 1e-300);
}

double SingularPassage::due(const eom::StepView& step) {
  const double h = step.t1 - step.t0, size = std::abs(h);
  if (longest_ == 0) measure_ = rank_measure(step.t0, step.x0.data());
  longest_ = std::max(longest_, size);
  if (size >= shorter * longest_ && measure_ > soon && ++unseen_ < look_every) return 0;
  unseen_ = 0;
  measure_ = rank_measure(step.t1, step.x1.data());
  if (!(measure_ < near)) nearest_ = 0;
  if (!(measure_ < near && measure_ > redundant)) return 0;
  ahead_ = Eigen::Map<const Eigen::VectorXd>(step.x1.data(), static_cast<Eigen::Index>(step.x1.size()));
  for (std::size_t i = 0; i < n_; ++i) ahead_[static_cast<Eigen::Index>(i)] += look_ahead * h * step.x1[n_ + i];
  const double decrease = measure_ - rank_measure(step.t1 + look_ahead * h, ahead_.data());
  distance_ = decrease > 0 ? look_ahead * size * measure_ / decrease : std::numeric_limits<double>::infinity();
  if (!std::isfinite(distance_) || (nearest_ > 0 && distance_ > nearest_)) return 0;
  return distance_ / place;
}

void SingularPassage::passed(double length) {
  longest_ = length;
  nearest_ = 0;
}

}  // namespace eomgen::run
