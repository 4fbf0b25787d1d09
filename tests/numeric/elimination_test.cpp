// SPDX-License-Identifier: GPL-3.0-or-later
// Elimination for every number type: known solutions, ranks and null spaces.
#include "numeric/elimination.hpp"

#include <cln/float.h>
#include <doctest/doctest.h>

#include <cmath>

using namespace eomgen::numeric;
using cln::cl_R;
using cln::cl_RA;

namespace {

template <class T>
Matrix<T> matrix(std::size_t rows, std::size_t cols, std::initializer_list<int> entries) {
  Matrix<T> A(rows, cols);
  std::size_t i = 0;
  for (const int entry : entries) A.a[i++] = T(entry);
  return A;
}

/// The largest entry of A - B.
template <class T>
T distance(const Matrix<T>& A, const Matrix<T>& B) {
  T largest(0);
  for (std::size_t i = 0; i < A.a.size(); ++i) largest = std::max(largest, magnitude(T(A.a[i] - B.a[i])));
  return largest;
}

/// The Hilbert matrix in floats of 60 digits. Its condition number grows like 34^n.
Matrix<cl_R> hilbert(std::size_t n) {
  Matrix<cl_R> A(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      A(i, j) = cln::cl_float(cl_R(cl_RA(1) / cl_RA(static_cast<long>(i + j + 1))), cln::float_format(60));
  }
  return A;
}

}  // namespace

TEST_CASE_TEMPLATE("a system with zeros on its diagonal is solved", T, double, cl_R, cl_RA) {
  const Matrix<T> A = matrix<T>(3, 3, {0, 2, 1, 1, 0, 0, 3, 0, 4}), x = matrix<T>(3, 2, {1, 4, 2, 5, 3, 6});
  const Elimination<T> factors(A, T(0), Pivoting::complete);
  CHECK(factors.rank() == 3);
  const T off = distance(factors.solve(A * x), x);
  CHECK(bool(off < T(1) / T(1000000000)));
}

TEST_CASE("rationals are exact") {
  Matrix<cl_RA> A(6, 6), unit(6, 6);
  for (std::size_t i = 0; i < 6; ++i) {
    unit(i, i) = 1;
    for (std::size_t j = 0; j < 6; ++j) A(i, j) = cl_RA(1) / cl_RA(static_cast<long>(i + j + 1));
  }
  const Matrix<cl_RA> inverse = Elimination<cl_RA>(A, 0, Pivoting::complete).solve(unit);
  CHECK(is_zero(distance(A * inverse, unit)));
  CHECK(inverse(5, 5) == cl_RA(698544));  // of Hilbert's matrix
}

TEST_CASE("the rank, pivot columns and null space of a matrix with dependent columns") {
  const Matrix<double> A =
      matrix<double>(3, 4, {1, 2, 3, 4, 2, 4, 6, 9, 1, 2, 3, 5});  // the last row: the second less the first
  const Elimination<double> factors(A, 1e-12, Pivoting::complete);
  CHECK(factors.rank() == 2);
  CHECK(factors.pivot_columns().front() == 3);
  const Matrix<double> N = factors.null_space();
  REQUIRE(N.cols == 2);
  CHECK(distance(A * N, Matrix<double>(3, 2)) < 1e-14);
}

TEST_CASE("scaled rows and columns: a system in very different units has full rank") {
  const Matrix<double> A = [] {
    Matrix<double> B = matrix<double>(2, 2, {2, 1, 1, 3});
    for (std::size_t j = 0; j < 2; ++j) B(1, j) *= 1e-20;
    return B;
  }();
  CHECK(Elimination<double>(A, 1e-9).rank() == 2);
  CHECK(Elimination<double>(A, 1e-9, Pivoting::complete).rank() == 1);
}

TEST_CASE("diagonal pivoting distinguishes a positive definite matrix from a semidefinite one") {
  const Matrix<cl_R> definite = hilbert(8);
  const cl_R nothing = cln::expt(cl_RA(1) / 10, 30);
  CHECK(Elimination<cl_R>(definite, nothing, Pivoting::diagonal).rank() == 8);
  // v v^T + w w^T with v = (1, 2, 0), w = (0, 1, 1)
  const Matrix<cl_R> semidefinite = matrix<cl_R>(3, 3, {1, 2, 0, 2, 5, 1, 0, 1, 1});
  CHECK(Elimination<cl_R>(semidefinite, nothing, Pivoting::diagonal).rank() == 2);
}

TEST_CASE("the error in sixty digits is bounded by the condition number of the matrix") {
  const Matrix<cl_R> A = hilbert(8);
  Matrix<cl_R> x(8, 1);
  for (std::size_t i = 0; i < 8; ++i) x(i, 0) = cl_R(static_cast<long>(i) - 3);
  for (const Pivoting pivots : {Pivoting::complete, Pivoting::diagonal}) {
    const cl_R off = distance(Elimination<cl_R>(A, 0, pivots).solve(A * x), x);
    CHECK(bool(off < cln::expt(cl_RA(1) / 10, 45)));
  }
}

TEST_CASE("binary64 numbers are converted exactly, including subnormal ones") {
  CHECK(exact(0.375) == cl_RA(3) / 8);
  CHECK(exact(-0.0) == 0);
  for (const double x : {-1e-310, 2.2250738585072014e-308, 1e100})
    CHECK(exact(x) * cln::expt_pos(cln::cl_I(2), 300) == exact(std::ldexp(x, 300)));
  CHECK(exact(5e-324) * cln::expt_pos(cln::cl_I(2), 1074) == 1);
}
