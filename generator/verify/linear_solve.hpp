// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems over CLN reals.
#pragma once

#include <cmath>
#include <vector>

#include "verify/jet.hpp"

namespace eomgen::verify {

struct Solution {
  std::vector<Real> unknowns;  // empty where the matrix is singular to working precision
  /// Ratio of the extreme pivots after rows and columns were scaled to 1: a measure of the condition. Infinite where
  /// the matrix is singular.
  double condition = 1;
  std::vector<std::vector<double>> inverse;  // the sizes of its columns' entries, where asked for

  bool exists() const { return !std::isinf(condition); }
  const std::vector<Real>& x() const { return unknowns; }
};

/// A power of two near |x| (sign 1) or 1/|x| (sign -1), x != 0, at the precision of x: scaling by it rounds nothing.
Real power_of_two_near(const Real& x, int sign);

/// A x = b with A n x n, row-major; parts that do not hang together each alone, by Gaussian elimination with complete
/// pivoting of the scaled matrix. Large parts are eliminated in binary64 and refined: each residual, in all digits,
/// takes off as many digits as binary64 has beyond the condition; where that does not converge, elimination in all
/// digits it is.
Solution solve(std::vector<Real> A, std::vector<Real> b, bool with_inverse = false);

}  // namespace eomgen::verify
