// SPDX-License-Identifier: GPL-3.0-or-later
// Motions of linear equations, as references for runs. Compiled only once, because decompositions and products of
// matrices take the compiler seconds.
#pragma once

#include <vector>

namespace eomgen::test {

using Matrix = std::vector<std::vector<double>>;  // by rows

/// x(t) of x' = A x from `start`, by the series of exp(A t / 2^k), squared k times.
std::vector<double> linear_motion(const Matrix& A, const std::vector<double>& start, double t);

/// x1, x2, x1', x2' of m1 x1'' = -k1 x1 + k2 (x2 - x1), m2 x2'' = -k2 (x2 - x1), from rest at x1 = 0.1, x2 = 0.
std::vector<double> two_masses(double m1, double m2, double k1, double k2, double t);

}  // namespace eomgen::test
