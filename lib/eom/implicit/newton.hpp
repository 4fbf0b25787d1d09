// SPDX-License-Identifier: MIT
// End of a simplified Newton iteration without a tolerance: convergence to rounding. In: the relative size of each
// correction. Out: whether it continues, has converged, or has failed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "eom/implicit/jacobian.hpp"

namespace eom::implicit {

class RoundingConvergence {
 public:
  enum class State { iterating, converged, failed };

  static constexpr int most_iterations = 50;

  /// To be called after each correction, including the first.
  State update(double size) {
    ++iterations_;
    if (size == 0) return State::converged;
    if (iterations_ > 1) {
      const double ratio = size / before_;
      if (iterations_ == 2) contraction_ = size > contraction_floor ? ratio : 0;
      if (ratio > 0.95 && size < stagnant) return State::converged;  // only rounding remains
      if (ratio > 2 && ++growths_ > most_growths) return State::failed;
      if (ratio < 1 && ratio / (1 - ratio) * size <= negligible) return State::converged;
    }
    before_ = size;
    return iterations_ < most_iterations ? State::iterating : State::failed;
  }

  /// Ratio of the second correction to the first: the quality of the matrix.
  double contraction() const { return contraction_; }

 private:
  static constexpr double stagnant = 1e-5, contraction_floor = 1e-8;
  // The neglected remainder has the same sign in every step and accumulates. Compensated sums resolve more than a
  // rounding of x.
  static constexpr double negligible = std::numeric_limits<double>::epsilon() / 1024;
  static constexpr int most_growths =
      2;  // a component that first changes in a later correction makes that one large once
  int iterations_ = 0, growths_ = 0;
  double before_ = 0, contraction_ = 0;
};

/// The units in which the components of a correction are small. The unit is a component's own size if it exceeds the
/// rounding of the other components. Their rounding contributes eps w_i to component i, where (I - h J) w = |h J| |x|:
/// it enters through the arguments of f, and the matrix of the iteration distributes it. In a unit of 1e-6 w_i this is
/// 2e-10. 50000 times this value, by cancellation within f, still counts as stagnation (RoundingConvergence::stagnant).
/// A component that is smaller than w_i by any factor down to 1e-6 keeps all its digits. The w_i have the dimensions of
/// the x_i. If a constraint fixes a component at 0, w_i is 0, and the unit is 1e-25 of the largest of all.
class CorrectionUnits {
 public:
  /// unknowns: size of the matrix; the first m are components.
  CorrectionUnits(std::size_t m, std::size_t unknowns) : m_(m), w_(unknowns) {}

  /// Computes the w_i for a step h from x with derivative f. solve(vector): solves with the matrix of the iteration, up
  /// to a factor; part: h times that factor. border(w, sizes): right-hand sides of unknowns beyond the components.
  template <class Solve, class Border>
  void compute(const Jacobian& jacobian, const double* x, const double* f, double h, double part, Solve solve,
               Border border) {
    std::fill(w_.begin(), w_.end(), 0.0);
    least_ = 0;
    const auto size = [&](std::size_t j) { return std::max(std::abs(x[j]), std::abs(h * f[j])); };
    for (std::size_t j = 0; j < m_; ++j) {
      const double moves = std::abs(part) * size(j);
      least_ = std::max(least_, of_all * size(j));
      for (std::size_t i = 0; i < m_; ++i) w_[i] += std::abs(jacobian(i, j)) * moves;
    }
    for (std::size_t i = 0; i < m_; ++i)
      w_[i] *= 1 + 0.1 * static_cast<double>(i % 7);  // prevents symmetries of the matrix from making one 0
    border(w_.data(), size);
    solve(w_.data());
  }

  /// The unit of a component with this size before the correction, or after it.
  double operator()(std::size_t i, double size, double correction) const {
    return std::max({size, smallest * std::abs(w_[i]), least_, std::abs(correction)});
  }

 private:
  static constexpr double smallest = 1e-6, of_all = 1e-25;
  std::size_t m_;
  double least_ = 0;
  std::vector<double> w_;
};

}  // namespace eom::implicit
