// SPDX-License-Identifier: MIT
// When a simplified Newton iteration without a tolerance ends: at rounding. In: the relative size of each correction.
// Out: whether it goes on, has converged, or will not.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "eom/implicit/jacobian.hpp"

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
      if (iterations_ == 2) contraction_ = size > too_small_to_tell ? ratio : 0;
      if (ratio > 0.95 && size < stagnant) return State::converged;  // rounding is what is left
      if (ratio > 2 && ++growths_ > most_growths) return State::failed;
      if (ratio < 1 && ratio / (1 - ratio) * size <= negligible) return State::converged;
    }
    before_ = size;
    return iterations_ < most_iterations ? State::goes_on : State::failed;
  }

  /// Of the second correction beside the first: how well the matrix suits.
  double contraction() const { return contraction_; }

 private:
  static constexpr double stagnant = 1e-5, too_small_to_tell = 1e-8;
  // What is left out has the same sign in every step, so that it adds up; sums with remainders resolve more than a
  // rounding of x.
  static constexpr double negligible = std::numeric_limits<double>::epsilon() / 1024;
  static constexpr int most_growths =
      2;  // a component that first stirs in a later correction makes that one large once
  int iterations_ = 0, growths_ = 0;
  double before_ = 0, contraction_ = 0;
};

/// In what units the components of a correction are small. A component's own size is the unit as long as it is more
/// than rounding of the others. What their rounding makes of component i is eps w_i, where (I - h J) w = |h J| |x|:
/// they enter through the arguments of f, and the matrix of the iteration spreads them. In a unit of 1e-6 w_i that is
/// 2e-10; 50000 times that, by cancellation within f, still counts as rest (ToRounding::stagnant). A component that is
/// small beside w_i by any factor down to 1e-6 keeps all its digits. The w_i have the dimensions of the x_i. Where a
/// constraint pins a component at 0, w_i is 0; what is left then is 1e-25 of the largest of all.
class Units {
 public:
  /// unknowns: of the matrix, the first m of which are components.
  Units(std::size_t m, std::size_t unknowns) : m_(m), w_(unknowns) {}

  /// For a step h from x, where the derivative is f. solve(vector): by the matrix of the iteration, times any number;
  /// part: h by that number. border(w, sizes): right-hand sides of unknowns beyond the components.
  template <class Solve, class Border>
  void see(const Jacobian& jacobian, const double* x, const double* f, double h, double part, Solve solve,
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
      w_[i] *= 1 + 0.1 * static_cast<double>(i % 7);  // so that no symmetry of the matrix makes one 0
    border(w_.data(), size);
    solve(w_.data());
  }

  /// The unit of a component that is as large as this before the correction, or after it.
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
