// SPDX-License-Identifier: MIT
// The constraint equations g = (psi of the position constraints, A v + b of all constraints) of a method, each scaled
// by the length of its row of A. In: a system, states. Out: values, their rounding, an independent set of rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eom/system.hpp"

namespace eom::constrained {

/// The constraints of a system at one state: values, their derivatives, and a selection of independent rows.
class ConstraintEquations {
 public:
  /// The system must outlive this object.
  explicit ConstraintEquations(const System& system)
      : of_(system),
        c_(system.coordinates),
        k_(system.constraints),
        positions_(system.position_constraints),
        psi_(k_),
        A_(k_ * c_),
        b_(k_),
        length_(k_, 1.0),
        remainder_(k_ * c_),
        selected_(k_) {}

  /// Number of equations.
  std::size_t size() const { return positions_ + k_; }
  /// Number of leading equations that constrain positions.
  std::size_t position_row_count() const { return positions_; }
  /// The row of A that belongs to g_a.
  std::size_t row(std::size_t a) const { return a < positions_ ? a : a - positions_; }
  /// Whether the row of equation a is one of the independent ones.
  bool is_selected(std::size_t a) const { return selected_[row(a)]; }
  /// Entries of that row, scaled.
  double slope(std::size_t a, std::size_t i) const { return A_[row(a) + k_ * i] / length_[row(a)]; }

  /// Evaluates psi, A and b at a state. Returns a code.
  int evaluate(double t, const double* x) {
    const int code = of_.constrain(of_.self, t, x, psi_.data(), A_.data(), b_.data());
    const auto finite = [](double value) { return std::isfinite(value); };
    if (code != 0) return code;
    return std::all_of(A_.begin(), A_.end(), finite) && std::all_of(b_.begin(), b_.end(), finite) &&
                   std::all_of(psi_.begin(), psi_.begin() + static_cast<std::ptrdiff_t>(positions_), finite)
               ? 0
               : code_not_finite;
  }

  /// Computes the lengths and selects a maximal independent set of rows, position constraints first: Gram-Schmidt, with
  /// the largest remaining row as pivot.
  void select_independent() {
    for (std::size_t r = 0; r < k_; ++r) {
      double sum = 0;
      for (std::size_t i = 0; i < c_; ++i) sum += A_[r + k_ * i] * A_[r + k_ * i];
      length_[r] = sum > 0 ? std::sqrt(sum) : 1;
      for (std::size_t i = 0; i < c_; ++i) remainder_[r + k_ * i] = A_[r + k_ * i] / length_[r];
    }
    std::fill(selected_.begin(), selected_.end(), false);
    while (select_largest_row(0, positions_)) {
    }
    while (select_largest_row(positions_, k_)) {
    }
  }

  /// g_a of the state last evaluated.
  double value(std::size_t a, const double* x) const {
    const std::size_t r = row(a);
    if (a < positions_) return psi_[r] / length_[r];
    double sum = b_[r];
    for (std::size_t i = 0; i < c_; ++i) sum += A_[r + k_ * i] * x[c_ + i];
    return sum / length_[r];
  }

  /// The size of the terms of g_a; |A| |q| replaces those of psi.
  double terms(std::size_t a, const double* x) const {
    const std::size_t r = row(a);
    double sum = a < positions_ ? 0 : std::abs(b_[r]);
    for (std::size_t i = 0; i < c_; ++i) sum += std::abs(A_[r + k_ * i] * x[(a < positions_ ? 0 : c_) + i]);
    return sum / length_[r];
  }

  /// Whether all of g, including rows that are not selected, is 0 up to the fraction `part` of the coordinates or
  /// rates.
  bool are_satisfied(const double* x, double part) const {
    double sizes[2]{1, 1};
    for (std::size_t i = 0; i < 2 * c_; ++i) sizes[i / c_] = std::max(sizes[i / c_], std::abs(x[i]));
    for (std::size_t a = 0; a < size(); ++a)
      if (!(std::abs(value(a, x)) <= part * sizes[a < positions_ ? 0 : 1])) return false;
    return true;
  }

 private:
  static constexpr double independent = 1e-10;  // of a row's length: a smaller remainder is rounding of a dependent row

  bool select_largest_row(std::size_t begin, std::size_t end) {
    std::size_t best = end;
    double largest = independent * independent;
    for (std::size_t r = begin; r < end; ++r) {
      double sum = 0;
      for (std::size_t i = 0; i < c_; ++i) sum += remainder_[r + k_ * i] * remainder_[r + k_ * i];
      if (!selected_[r] && sum > largest) best = r, largest = sum;
    }
    if (best == end) return false;
    selected_[best] = true;
    const double length = std::sqrt(largest);
    for (std::size_t i = 0; i < c_; ++i) remainder_[best + k_ * i] /= length;
    for (std::size_t r = 0; r < k_; ++r) {
      if (selected_[r]) continue;
      double along = 0;
      for (std::size_t i = 0; i < c_; ++i) along += remainder_[r + k_ * i] * remainder_[best + k_ * i];
      for (std::size_t i = 0; i < c_; ++i) remainder_[r + k_ * i] -= along * remainder_[best + k_ * i];
    }
    return true;
  }

  const System& of_;
  std::size_t c_, k_, positions_;
  std::vector<double> psi_, A_, b_, length_, remainder_;
  std::vector<bool> selected_;
};

}  // namespace eom::constrained
