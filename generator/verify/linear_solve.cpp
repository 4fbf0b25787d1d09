// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/linear_solve.hpp"

#include <cln/integer.h>
#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace eomgen::verify {
namespace {

/// A power of two near 1/|x|: scaling by it rounds nothing.
Real inverse_magnitude(const Real& x) {
  if (cln::zerop(x)) return 1;
  const double size = cln::double_approx(cln::abs(x));
  return cln::expt(Real(2), cln::cl_I(-std::ilogb(size)));
}

struct Elimination {
  std::size_t n;
  std::vector<Real>& A;
  std::vector<std::vector<Real>>& B;
  std::vector<std::size_t> column;  // of the unknown that sits in each place
  std::vector<Real> column_scale;

  Real& at(std::size_t i, std::size_t k) { return A[i * n + k]; }

  void equilibrate() {
    for (std::size_t i = 0; i < n; ++i) {
      Real largest = 0;
      for (std::size_t k = 0; k < n; ++k) largest = cln::max(largest, cln::abs(at(i, k)));
      const Real s = inverse_magnitude(largest);
      for (std::size_t k = 0; k < n; ++k) at(i, k) = at(i, k) * s;
      for (std::vector<Real>& b : B) b[i] = b[i] * s;
    }
    for (std::size_t k = 0; k < n; ++k) {
      Real largest = 0;
      for (std::size_t i = 0; i < n; ++i) largest = cln::max(largest, cln::abs(at(i, k)));
      column_scale.push_back(inverse_magnitude(largest));
      for (std::size_t i = 0; i < n; ++i) at(i, k) = at(i, k) * column_scale[k];
    }
  }
  void pivot(std::size_t step) {
    std::size_t row = step, col = step;
    for (std::size_t i = step; i < n; ++i)
      for (std::size_t k = step; k < n; ++k)
        if (cln::abs(at(i, k)) > cln::abs(at(row, col))) row = i, col = k;
    if (row != step) {
      for (std::size_t k = 0; k < n; ++k) std::swap(at(row, k), at(step, k));
      for (std::vector<Real>& b : B) std::swap(b[row], b[step]);
    }
    if (col != step) {
      for (std::size_t i = 0; i < n; ++i) std::swap(at(i, col), at(i, step));
      std::swap(column[col], column[step]);
    }
  }
  void eliminate(std::size_t step) {
    for (std::size_t i = step + 1; i < n; ++i) {
      if (cln::zerop(at(i, step))) continue;
      const Real factor = at(i, step) / at(step, step);
      for (std::size_t k = step + 1; k < n; ++k) at(i, k) = at(i, k) - factor * at(step, k);
      for (std::vector<Real>& b : B) b[i] = b[i] - factor * b[step];
    }
  }
  std::vector<Real> substitute_back(const std::vector<Real>& b) {
    std::vector<Real> y(n), x(n);
    for (std::size_t i = n; i-- > 0;) {
      Real sum = b[i];
      for (std::size_t k = i + 1; k < n; ++k) sum = sum - at(i, k) * y[k];
      y[i] = sum / at(i, i);
    }
    for (std::size_t i = 0; i < n; ++i) x[column[i]] = y[i] * column_scale[column[i]];
    return x;
  }
};

}  // namespace

Solution solve(std::vector<Real> A, std::vector<std::vector<Real>> B) {
  const std::size_t n = B.front().size();
  Elimination e{n, A, B, std::vector<std::size_t>(n), {}};
  std::iota(e.column.begin(), e.column.end(), std::size_t{0});
  e.equilibrate();
  Solution solution;
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (std::size_t step = 0; step < n; ++step) {
    e.pivot(step);
    const double size = std::fabs(cln::double_approx(e.at(step, step)));
    largest = std::max(largest, size);
    smallest = std::min(smallest, size);
    if (size < 1e-30) {  // of a matrix scaled to 1
      solution.condition = std::numeric_limits<double>::infinity();
      return solution;
    }
    e.eliminate(step);
  }
  if (n > 0) solution.condition = largest / smallest;
  for (const std::vector<Real>& b : B) solution.columns.push_back(e.substitute_back(b));
  return solution;
}

}  // namespace eomgen::verify
