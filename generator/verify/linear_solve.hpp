// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense linear systems over CLN reals.
#pragma once

#include <vector>

#include "verify/jet.hpp"

namespace eomgen::verify {

struct Solution {
  std::vector<Real> x;
  /// Ratio of the extreme pivots after rows and columns were scaled to 1: a measure of the condition. Infinite where
  /// the matrix is singular to working precision; x is empty then.
  double condition = 1;
};

/// A x = b with A n x n, row-major; Gaussian elimination with complete pivoting of the scaled matrix.
Solution solve(std::vector<Real> A, std::vector<Real> b);

}  // namespace eomgen::verify
