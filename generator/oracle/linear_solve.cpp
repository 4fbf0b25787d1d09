// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/linear_solve.hpp"

#include <cln/float.h>
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/rational_ring.h>
#include <cln/real.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

namespace eomgen::verify {

Real power_of_two_near(const Real& x, int sign) {
  constexpr long exact = 1 << 16;  // a larger power of two has too many digits as a fraction
  // From a long float: a conversion to binary64 would overflow to infinity.
  const long exponent = cln::float_exponent(cln::cl_float(x, cln::float_format(20)));
  const long wanted = sign > 0 ? exponent : 1 - exponent;
  if (std::abs(wanted) < exact) return cln::expt(Real(2), cln::cl_I(wanted));
  return cln::scale_float(cln::cl_float(cln::cl_I(1), cln::cl_float(x)), cln::cl_I(wanted));
}

namespace {

/// A power of two; scaling by it is exact.
Real inverse_magnitude(const Real& x) { return cln::zerop(x) ? Real(1) : power_of_two_near(x, -1); }

/// Complete pivoting of a matrix that is scaled by powers of two; the same for CLN reals and for binary64.
template <class Number>
struct Elimination {
  std::size_t n;
  std::vector<Number> A;
  std::vector<std::size_t> row, column;  // of the original matrix, by position
  double largest = 0, smallest = std::numeric_limits<double>::infinity();

  Elimination(std::size_t size, std::vector<Number> matrix) : n(size), A(std::move(matrix)), row(n), column(n) {
    std::iota(row.begin(), row.end(), std::size_t{0});
    std::iota(column.begin(), column.end(), std::size_t{0});
  }
  Number& at(std::size_t i, std::size_t k) { return A[i * n + k]; }
  const Number& at(std::size_t i, std::size_t k) const { return A[i * n + k]; }

  static double size(double x) { return std::fabs(x); }
  static double size(const Real& x) { return std::fabs(cln::double_approx(x)); }
  static bool is_zero(double x) { return x == 0; }
  static bool is_zero(const Real& x) { return cln::zerop(x); }

  /// A = L U with the factors in place of A; false if A is singular to working precision.
  bool factor() {
    for (std::size_t step = 0; step < n; ++step) {
      const double pivot = choose(step);
      largest = std::max(largest, pivot);
      smallest = std::min(smallest, pivot);
      if (!(pivot >= 1e-30)) return false;  // the matrix is scaled to 1
      for (std::size_t i = step + 1; i < n; ++i) {
        if (is_zero(at(i, step))) continue;
        const Number factor = at(i, step) / at(step, step);
        at(i, step) = factor;
        for (std::size_t k = step + 1; k < n; ++k) {
          if (!is_zero(at(step, k))) at(i, k) = at(i, k) - factor * at(step, k);
        }
      }
    }
    return true;
  }
  double choose(std::size_t step) {
    std::size_t r = step, c = step;
    double best = size(at(step, step));
    for (std::size_t i = step; i < n; ++i)
      for (std::size_t k = step; k < n; ++k) {
        const double here = size(at(i, k));
        if (here > best) best = here, r = i, c = k;
      }
    if (r != step) {
      for (std::size_t k = 0; k < n; ++k) std::swap(at(r, k), at(step, k));
      std::swap(row[r], row[step]);
    }
    if (c != step) {
      for (std::size_t i = 0; i < n; ++i) std::swap(at(i, c), at(i, step));
      std::swap(column[c], column[step]);
    }
    return best;
  }
  /// x of A x = b
  std::vector<Number> operator()(const std::vector<Number>& b) const {
    std::vector<Number> y(n), x(n);
    for (std::size_t i = 0; i < n; ++i) {
      Number sum = b[row[i]];
      for (std::size_t k = 0; k < i; ++k) {
        if (!is_zero(at(i, k)) && !is_zero(y[k])) sum = sum - at(i, k) * y[k];
      }
      y[i] = sum;
    }
    for (std::size_t i = n; i-- > 0;) {
      Number sum = y[i];
      for (std::size_t k = i + 1; k < n; ++k) {
        if (!is_zero(at(i, k))) sum = sum - at(i, k) * y[k];
      }
      y[i] = sum / at(i, i);
    }
    for (std::size_t i = 0; i < n; ++i) x[column[i]] = y[i];
    return x;
  }
};

/// Rows and columns of one decoupled block, each list ascending.
struct Part {
  std::vector<std::size_t> rows, columns;
};

std::vector<Part> parts(const std::vector<Real>& A, std::size_t n) {
  std::vector<std::size_t> above(2 * n);  // rows, then columns
  std::iota(above.begin(), above.end(), std::size_t{0});
  const auto top = [&](std::size_t i) {
    while (above[i] != i) i = above[i] = above[above[i]];
    return i;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      if (cln::zerop(A[i * n + k])) continue;
      const std::size_t a = top(i), b = top(n + k);
      above[std::max(a, b)] = std::min(a, b);
    }
  std::vector<Part> result;
  std::vector<std::size_t> place(2 * n, 2 * n);
  for (std::size_t i = 0; i < 2 * n; ++i) {
    std::size_t& at = place[top(i)];
    if (at == 2 * n) {
      at = result.size();
      result.emplace_back();
    }
    if (i < n)
      result[at].rows.push_back(i);
    else
      result[at].columns.push_back(i - n);
  }
  return result;
}

/// The widest float format among the numbers; none if all are exact.
std::optional<cln::float_format_t> format_of(const std::vector<Real>& numbers) {
  std::optional<cln::float_format_t> widest;
  for (const Real& number : numbers) {
    if (cln:: instanceof (number, cln::cl_RA_ring)) continue;
    const auto own = static_cast<cln::float_format_t>(cln::float_digits(cln::the<cln::cl_F>(number)));
    if (!widest || own > *widest) widest = own;
  }
  return widest;
}

Real largest_of(const std::vector<Real>& v) {
  Real largest = 0;
  for (const Real& value : v) largest = cln::max(largest, cln::abs(value));
  return largest;
}

/// Solves A x = b by refinement with factors of A in binary64; nothing if it does not converge.
std::optional<std::vector<Real>> refined(const std::vector<Real>& A, const std::vector<Real>& b,
                                         const Elimination<double>& rough) {
  const std::size_t n = b.size();
  const auto format = format_of(A);
  if (!format) return std::nullopt;
  std::vector<std::vector<std::size_t>> filled(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      if (!cln::zerop(A[i * n + k])) filled[i].push_back(k);
  const Real last_digit = cln::float_epsilon(*format) * 8;
  std::vector<Real> x(n, Real(0));
  constexpr int most = 60;
  Real before = 0;
  for (int iteration = 0; iteration < most; ++iteration) {
    std::vector<Real> residual = b;
    for (std::size_t i = 0; i < n; ++i)
      for (const std::size_t k : filled[i]) residual[i] = residual[i] - A[i * n + k] * x[k];
    const Real scale = largest_of(residual);
    if (cln::zerop(scale)) return x;
    const Real unit = inverse_magnitude(scale);
    std::vector<double> small;
    for (const Real& r : residual) small.push_back(cln::double_approx(r * unit));
    const std::vector<double> step = rough(small);
    Real change = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::isfinite(step[i])) return std::nullopt;
      if (step[i] == 0) continue;
      const Real d = cln::cl_float(exact(step[i]), *format) / unit;
      x[i] = x[i] + d;
      change = cln::max(change, cln::abs(d));
    }
    if (change <= last_digit * largest_of(x)) return x;
    // Each step has to be smaller than the previous one by some digits.
    if (iteration > 0 && change * 16 > before) return std::nullopt;
    before = change;
  }
  return std::nullopt;
}

std::vector<std::vector<double>> inverse_of(const Elimination<double>& factors) {
  std::vector<std::vector<double>> columns;
  for (std::size_t k = 0; k < factors.n; ++k) {
    std::vector<double> unit(factors.n, 0.0);
    unit[k] = 1;
    columns.push_back(factors(unit));
  }
  return columns;
}

std::vector<double> rounded(const std::vector<Real>& values) {
  std::vector<double> result;
  for (const Real& value : values) result.push_back(cln::double_approx(value));
  return result;
}

struct PartSolution {
  std::vector<Real> x;  // none: singular
  std::vector<std::vector<double>> inverse;
  double largest = 0, smallest = 0;
};

PartSolution solve_part(std::vector<Real> A, const std::vector<Real>& b, bool with_inverse) {
  constexpr std::size_t worth_refining = 12;  // unknowns
  constexpr double worst = 1e10;              // condition that leaves binary64 some digits
  const std::size_t n = b.size();
  if (n > worth_refining) {
    Elimination<double> rough(n, rounded(A));
    if (rough.factor() && rough.largest < worst * rough.smallest) {
      if (auto x = refined(A, b, rough)) {
        return {std::move(*x), with_inverse ? inverse_of(rough) : std::vector<std::vector<double>>{}, rough.largest,
                rough.smallest};
      }
    }
  }
  Elimination<Real> exact(n, std::move(A));
  if (!exact.factor()) return {};
  PartSolution result{exact(b), {}, exact.largest, exact.smallest};
  if (with_inverse) {
    Elimination<double> factors(n, rounded(exact.A));
    factors.row = exact.row;
    factors.column = exact.column;
    result.inverse = inverse_of(factors);
  }
  return result;
}

}  // namespace

Solution solve(std::vector<Real> A, std::vector<Real> b, bool with_inverse) {
  const std::size_t n = b.size();
  std::vector<Real> row_scale, column_scale;
  for (std::size_t i = 0; i < n; ++i) {
    Real largest = 0;
    for (std::size_t k = 0; k < n; ++k) largest = cln::max(largest, cln::abs(A[i * n + k]));
    row_scale.push_back(inverse_magnitude(largest));
    for (std::size_t k = 0; k < n; ++k)
      if (!cln::zerop(A[i * n + k])) A[i * n + k] = A[i * n + k] * row_scale[i];
    b[i] = b[i] * row_scale[i];
  }
  for (std::size_t k = 0; k < n; ++k) {
    Real largest = 0;
    for (std::size_t i = 0; i < n; ++i) largest = cln::max(largest, cln::abs(A[i * n + k]));
    column_scale.push_back(inverse_magnitude(largest));
    for (std::size_t i = 0; i < n; ++i)
      if (!cln::zerop(A[i * n + k])) A[i * n + k] = A[i * n + k] * column_scale[k];
  }
  Solution solution;
  solution.unknowns.assign(n, Real(0));
  if (with_inverse) solution.inverse.assign(n, std::vector<Real>(n, Real(0)));
  const auto singular = [] {
    Solution none;
    none.condition = std::numeric_limits<double>::infinity();
    return none;
  };
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (const Part& part : parts(A, n)) {
    if (part.rows.size() != part.columns.size()) return singular();
    std::vector<Real> own, right;
    for (const std::size_t i : part.rows) {
      for (const std::size_t k : part.columns) own.push_back(A[i * n + k]);
      right.push_back(b[i]);
    }
    const PartSolution found = solve_part(std::move(own), right, with_inverse);
    if (found.x.empty()) return singular();
    largest = std::max(largest, found.largest);
    smallest = std::min(smallest, found.smallest);
    for (std::size_t k = 0; k < part.columns.size(); ++k)
      solution.unknowns[part.columns[k]] = found.x[k] * column_scale[part.columns[k]];
    for (std::size_t i = 0; i < found.inverse.size(); ++i) {
      for (std::size_t k = 0; k < part.columns.size(); ++k)
        solution.inverse[part.rows[i]][part.columns[k]] =
            exact(std::fabs(found.inverse[i][k])) * row_scale[part.rows[i]] * column_scale[part.columns[k]];
    }
  }
  if (n > 0) solution.condition = largest / smallest;
  return solution;
}

}  // namespace eomgen::verify
