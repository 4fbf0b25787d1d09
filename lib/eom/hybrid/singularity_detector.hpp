// SPDX-License-Identifier: MIT
// Detection of configurations at which active constraints lose rank for an instant (the bars of a mechanism that are
// aligned). The motion is smooth there. However, stages slightly off the constraints have force errors inversely
// proportional to the distance. An adaptive solver then makes ever shorter steps before the configuration, or crosses
// it in a step that its projection spoils. In: accepted steps. Out: whether such a configuration is ahead and near, and
// a step across it whose stages keep their distance.
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

class SingularityDetector {
 public:
  /// Writes A of a state, rows x n in column order; returns a code.
  using Rows = std::function<int(double t, const double* x, double* A)>;

  SingularityDetector(std::size_t n, std::size_t rows, Rows evaluate);

  /// After an accepted step: the length (> 0) of a step across a nearby rank-deficient configuration, else 0. It is not
  /// evaluated after every step.
  double due_length(const StepView& step);
  /// Called after the step across has been made; or after it was not accurate enough, so that it is tried again at half
  /// the distance.
  void mark_passed(double length);
  void mark_refused() { nearest_ = 0.5 * distance_; }
  /// Whether a step across the configuration ahead has been refused.
  bool was_refused() const { return nearest_ > 0; }

  /// Whether rank is lost in the step across. `at`: the state at its target.
  bool is_rank_lost(double t, const double* at) { return rank_measure(t, at) < 0.2 * measure_; }
  /// The row of A that depends on others at the loss of rank, as last measured.
  std::size_t row() const { return row_; }
  /// Relative rounding of a step across from its starting point.
  double rounding() const { return 32 * std::numeric_limits<double>::epsilon() / (measure_ * measure_); }

  static constexpr const char* solver = "dop853";
  /// The position of the configuration within the step across it: midway between the stages of DOP853 at 1/3 and 3/5.
  /// For the shorter step of the check: between those at 0.65 and 0.86.
  static constexpr double crossing_fraction = 0.4667, check_fraction = 0.754;

 private:
  static constexpr double near = 0.1;        // of the measure: rank is lost soon, almost linearly in time
  static constexpr double soon = 0.3;        // below this value the rank is measured after every step
  static constexpr int look_every = 8;       // steps, otherwise
  static constexpr double redundant = 1e-9;  // below this value rows are permanently dependent
  static constexpr double shorter =
      0.7;  // of the longest step so far: after a shorter step the rank is measured at once
  static constexpr double look_ahead = 1e-3;  // of the step, for the slope of the measure

  /// The last pivot of a pivoted QR of A^T relative to the first, with rows of A scaled by their longest lengths so
  /// far. 0 if a row depends on others.
  double rank_measure(double t, const double* x);
  /// The same at another state with the order of rows of the last call, so that the measure is smooth.
  double rank_measure_in_order(double t, const double* x);
  /// False: A has no value, or more rows than columns.
  bool evaluate_rows(double t, const double* x);

  std::size_t n_;
  Rows evaluate_;
  Eigen::MatrixXd A_, transposed_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::HouseholderQR<Eigen::MatrixXd> ordered_;
  Eigen::VectorXd longest_row_, ahead_;
  double longest_ = 0;  // step since the start or the last crossing
  double measure_ = 0, distance_ = 0;
  double nearest_ = 0;  // only from a smaller distance than this; 0: from any
  std::size_t row_ = 0;
  int unseen_ = 0;  // steps since the last measurement
};

inline SingularityDetector::SingularityDetector(std::size_t n, std::size_t rows, Rows evaluate)
    : n_(n),
      evaluate_(std::move(evaluate)),
      A_(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(n)),
      transposed_(A_.cols(), A_.rows()),
      qr_(A_.cols(), A_.rows()),
      ordered_(A_.cols(), A_.rows()),
      longest_row_(Eigen::VectorXd::Zero(A_.rows())) {}

inline bool SingularityDetector::evaluate_rows(double t, const double* x) {
  if (A_.rows() == 0 || A_.rows() > A_.cols() || evaluate_(t, x, A_.data()) != 0 || !A_.allFinite()) return false;
  for (Eigen::Index i = 0; i < A_.rows(); ++i) {
    longest_row_(i) = std::max(longest_row_(i), A_.row(i).norm());  // a row may vanish, for example for aligned bars
    transposed_.col(i) = A_.row(i).transpose() / (longest_row_(i) > 0 ? longest_row_(i) : 1);
  }
  return true;
}

inline double SingularityDetector::rank_measure(double t, const double* x) {
  if (!evaluate_rows(t, x)) return std::numeric_limits<double>::quiet_NaN();
  qr_.compute(transposed_);
  row_ = static_cast<std::size_t>(qr_.colsPermutation().indices()(A_.rows() - 1));
  return std::abs(qr_.matrixQR()(A_.rows() - 1, A_.rows() - 1)) / std::max(qr_.maxPivot(), 1e-300);
}

inline double SingularityDetector::rank_measure_in_order(double t, const double* x) {
  if (!evaluate_rows(t, x)) return std::numeric_limits<double>::quiet_NaN();
  ordered_.compute(transposed_ * qr_.colsPermutation());
  return std::abs(ordered_.matrixQR()(A_.rows() - 1, A_.rows() - 1)) / std::max(qr_.maxPivot(), 1e-300);
}

inline double SingularityDetector::due_length(const StepView& step) {
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
  const double decrease = measure_ - rank_measure_in_order(step.t1 + look_ahead * h, ahead_.data());
  distance_ = decrease > 0 ? look_ahead * size * measure_ / decrease : std::numeric_limits<double>::infinity();
  if (!std::isfinite(distance_) || (nearest_ > 0 && distance_ > nearest_)) return 0;
  return distance_ / crossing_fraction;
}

inline void SingularityDetector::mark_passed(double length) {
  longest_ = length;
  nearest_ = 0;
}

}  // namespace eom::hybrid
