// SPDX-License-Identifier: MIT
// Where active constraints lose rank for an instant (the bars of a mechanism that lie flat). The motion goes on
// smoothly there, but stages beside the constraints see forces too large by one over the distance, so that a solver
// that chooses its steps makes them ever shorter before the place, or passes it in one that its projection spoils. In:
// accepted steps. Out: whether such a place is ahead and near, and a step over it whose stages keep their distance.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "eom/run_types.hpp"

namespace eom::hybrid {

class SingularPassage {
 public:
  /// A of a state, rows x n in column order; a code.
  using Rows = std::function<int(double t, const double* x, double* A)>;

  SingularPassage(std::size_t n, std::size_t rows, Rows evaluate);

  /// After an accepted step: the length (> 0) of a step over a place of lost rank that is near, else 0. Not looked at
  /// after every step.
  double due(const StepView& step);
  /// The passage that was due has been made; or was not accurate enough, and is tried again from half as far.
  void passed(double length);
  void refused() { nearest_ = 0.5 * distance_; }

  /// Whether rank is lost in a step from x to the place of its length that the passage aimed at: there, of the state
  /// `at`.
  bool lost(double t, const double* at) { return rank_measure(t, at) < 0.2 * measure_; }
  /// The row of A that follows from others where the rank is lost, as last measured.
  std::size_t row() const { return row_; }
  /// Relative rounding of a step over the place from where it was due.
  double rounding() const { return 8 * std::numeric_limits<double>::epsilon() / (measure_ * measure_); }

  static constexpr const char* solver = "dop853";
  /// Where in a step over it the place lies: midway between the stages of DOP853 at 1/3 and 3/5; and between those at
  /// 0.65 and 0.86, for the shorter step of the check.
  static constexpr double place = 0.4667, place_of_check = 0.754;

 private:
  static constexpr double near = 0.1;        // of the measure: rank is lost soon, and its decrease is close to linear
  static constexpr double soon = 0.3;        // from here on it is looked at after every step
  static constexpr int look_every = 8;       // steps, else
  static constexpr double redundant = 1e-9;  // below it rows follow from others all the time
  static constexpr double shorter =
      0.7;  // than the longest step so far: the solver has met something, and it is looked at at once
  static constexpr double look_ahead = 1e-3;  // of the step, for the slope of the measure

  /// The last pivot of a pivoted QR of A^T relative to the first, rows of A relative to the longest that they were: 0
  /// where one follows from others.
  double rank_measure(double t, const double* x);

  std::size_t n_;
  Rows evaluate_;
  Eigen::MatrixXd A_, transposed_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::VectorXd longest_row_, ahead_;
  double longest_ = 0;  // step since the start or the last passage
  double measure_ = 0, distance_ = 0;
  double nearest_ = 0;  // only from nearer than this; 0: from anywhere
  std::size_t row_ = 0;
  int unseen_ = 0;  // steps since it was looked at
};

inline SingularPassage::SingularPassage(std::size_t n, std::size_t rows, Rows evaluate)
    : n_(n),
      evaluate_(std::move(evaluate)),
      A_(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(n)),
      transposed_(A_.cols(), A_.rows()),
      qr_(A_.cols(), A_.rows()),
      longest_row_(Eigen::VectorXd::Zero(A_.rows())) {}

inline double SingularPassage::rank_measure(double t, const double* x) {
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

inline double SingularPassage::due(const StepView& step) {
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

inline void SingularPassage::passed(double length) {
  longest_ = length;
  nearest_ = 0;
}

}  // namespace eom::hybrid
