// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems over CLN reals.
#pragma once

#include <cmath>
#include <vector>

#include "oracle/jet.hpp"

namespace eomgen::verify {

struct Solution {
  std::vector<Real> unknowns;  // empty if the matrix is singular to working precision
  /// Ratio of the extreme pivots after rows and columns were scaled to 1: a measure of the condition. Infinite if the
  /// matrix is singular.
  double condition = 1;
  /// Absolute values of its columns' entries, if requested. They may be outside the range of binary64.
  std::vector<std::vector<Real>> inverse;

  bool exists() const { return !std::isinf(condition); }
  const std::vector<Real>& x() const { return unknowns; }
};

/// A power of two near |x| (sign 1) or 1/|x| (sign -1), x != 0, at the precision of x. Scaling by it is exact.
Real power_of_two_near(const Real& x, int sign);

/// Solves A x = b with A n x n, row-major, by Gaussian elimination with complete pivoting of the scaled matrix.
/// Decoupled blocks are solved one by one. Large blocks are eliminated in binary64 and refined with residuals in all
/// digits: each step gains the digits that binary64 has beyond the condition. If this does not converge, they are
/// eliminated in all digits.
Solution solve(std::vector<Real> A, std::vector<Real> b, bool with_inverse = false);

}  // namespace eomgen::verify
