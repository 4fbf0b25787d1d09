// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace eomgen::test {
namespace {

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result(a.size(), std::vector<double>(a.size(), 0.0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      for (std::size_t k = 0; k < a.size(); ++k) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

/// exp(A) - I; without the unit matrix, beside which small entries would lose their digits.
Matrix expm1(Matrix A) {
  double norm = 0;
  for (const std::vector<double>& row : A) {
    double sum = 0;
    for (const double entry : row) sum += std::abs(entry);
    norm = std::max(norm, sum);
  }
  int halvings = 0;
  for (; norm > 0.5; norm /= 2) ++halvings;
  for (std::vector<double>& row : A) {
    for (double& entry : row) entry = std::ldexp(entry, -halvings);
  }
  Matrix sum = A, term = A;
  for (int k = 2; k <= 16; ++k) {  // 0.5^17/17! is below the rounding
    term = product(term, A);
    for (std::size_t i = 0; i < A.size(); ++i) {
      for (std::size_t j = 0; j < A.size(); ++j) sum[i][j] += (term[i][j] /= k);
    }
  }
  for (; halvings > 0; --halvings) {  // (I + S)^2 - I = 2 S + S^2
    const Matrix square = product(sum, sum);
    for (std::size_t i = 0; i < A.size(); ++i) {
      for (std::size_t j = 0; j < A.size(); ++j) sum[i][j] = 2 * sum[i][j] + square[i][j];
    }
  }
  return sum;
}

}  // namespace

std::vector<double> linear_motion(const Matrix& A, const std::vector<double>& start, double t) {
  Matrix scaled = A;
  for (std::vector<double>& row : scaled) {
    for (double& entry : row) entry *= t;
  }
  const Matrix grown = expm1(scaled);
  std::vector<double> x = start;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) x[i] += grown[i][j] * start[j];
  }
  return x;
}

std::vector<double> two_masses(double m1, double m2, double k1, double k2, double t) {
  return linear_motion({{0, 0, 1, 0}, {0, 0, 0, 1}, {-(k1 + k2) / m1, k2 / m1, 0, 0}, {k2 / m2, -k2 / m2, 0, 0}},
                       {0.1, 0, 0, 0}, t);
}

}  // namespace eomgen::test
