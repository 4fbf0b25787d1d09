// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense linear systems over CLN reals.
#pragma once

#include <utility>
#include <vector>

#include "verify/jet.hpp"

namespace eomgen::verify {

struct Solution {
  std::vector<std::vector<Real>> columns;  // of X; empty where the matrix is singular to working precision
  /// Ratio of the extreme pivots after rows and columns were scaled to 1: a measure of the condition. Infinite where
  /// the matrix is singular.
  double condition = 1;

  bool exists() const { return !columns.empty(); }
  const std::vector<Real>& x() const { return columns.front(); }
};

/// A X = B with A n x n, row-major, B by columns (one at least); Gaussian elimination with complete pivoting of the
/// scaled matrix.
Solution solve(std::vector<Real> A, std::vector<std::vector<Real>> B);
/// A x = b
inline Solution solve(std::vector<Real> A, std::vector<Real> b) {
  return solve(std::move(A), std::vector<std::vector<Real>>{std::move(b)});
}

}  // namespace eomgen::verify
