// SPDX-License-Identifier: GPL-3.0-or-later
// Where active constraints lose rank for an instant (the bars of a mechanism that lie flat). The motion goes on
// smoothly there, but stages beside the constraints see forces too large by one over the distance, so that a solver
// that chooses its steps makes them ever shorter before the place, or passes it in one that its projection spoils. In:
// accepted steps. Out: whether such a place is ahead and near, and a step over it whose stages keep their distance.
#pragma once

#include <Eigen/Dense>
#include <eom/run_types.hpp>
#include <functional>
#include <limits>

namespace eomgen::run {

class SingularPassage {
 public:
  /// A of a state, rows x n in column order; a code.
  using Rows = std::function<int(double t, const double* x, double* A)>;

  SingularPassage(std::size_t n, std::size_t rows, Rows evaluate);

  /// After an accepted step: the length (> 0) of a step over a place of lost rank that is near, else 0. Not looked at
  /// after every step.
  double due(const eom::StepView& step);
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

}  // namespace eomgen::run
