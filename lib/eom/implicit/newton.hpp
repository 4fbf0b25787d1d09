// SPDX-License-Identifier: MIT
// When a simplified Newton iteration without a tolerance ends: at rounding. In: the relative size of each correction.
// Out: whether it goes on, has converged, or will not.
#pragma once

#include <limits>

namespace eom::implicit {

class ToRounding {
 public:
  enum class State { goes_on, converged, failed };

  static constexpr int most_iterations = 50;

  /// After each correction, the first too.
  State see(double size) {
    ++iterations_;
    if (size == 0) return State::converged;
    if (iterations_ > 1) {
      const double ratio = size / before_;
      if (iterations_ == 2) contraction_ = ratio;
      if (ratio > 0.95 && size < stagnant) return State::converged;  // rounding is what is left
      if (ratio > 2) return State::failed;
      if (ratio < 1 && ratio / (1 - ratio) * size <= std::numeric_limits<double>::epsilon() / 4) return State::converged;
    }
    before_ = size;
    return iterations_ < most_iterations ? State::goes_on : State::failed;
  }

  /// Of the second correction beside the first: how well the matrix suits.
  double contraction() const { return contraction_; }

 private:
  static constexpr double stagnant = 1e-5;
  int iterations_ = 0;
  double before_ = 0, contraction_ = 0;
};

}  // namespace eom::implicit
