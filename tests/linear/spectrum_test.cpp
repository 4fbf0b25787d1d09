// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/spectrum.hpp"

#include <doctest/doctest.h>

using namespace eomgen::linear;

namespace {

using Rows = std::vector<std::vector<double>>;

Matrix<Precise> matrix(const Rows& rows) {
  Matrix<Precise> A(rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) A(i, j) = number<Precise>(Precise(rows[i][j]));
  }
  return A;
}

/// S J S^-1 with a full S of small numbers.
Matrix<Precise> similar(const Rows& J) {
  const std::size_t n = J.size();
  Matrix<Precise> S(n, n), one(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    one(i, i) = Precise(1);
    for (std::size_t j = 0; j < n; ++j) S(i, j) = number<Precise>(Precise(static_cast<int>((3 * i * i + 7 * j + i * j) % 11) - 5 + (i == j ? 9 : 0)));
  }
  return S * matrix(J) * Elimination<Precise>(S, tiny<Precise>(100)).solve(one);
}

void same(const Spectrum& s, const std::vector<Eigenvalue>& expected) {
  REQUIRE(s.values.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(s.values[i].re == doctest::Approx(expected[i].re).epsilon(1e-15));
    CHECK(s.values[i].im == doctest::Approx(expected[i].im).epsilon(1e-15));
  }
}

}  // namespace

TEST_CASE("Jordan blocks stay whole: a triple 0, a double pair on the imaginary axis, a double -2") {
  const Spectrum s = spectrum(similar({{0, 1, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0, 0, 0},
                                       {0, 0, 0, 0, 3, 1, 0, 0, 0}, {0, 0, 0, -3, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 0, 0, 3, 0, 0},
                                       {0, 0, 0, 0, 0, -3, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0, -2, 1}, {0, 0, 0, 0, 0, 0, 0, 0, -2}}));
  CHECK(s.zeros == 3);
  same(s, {{0, 3}, {0, 3}, {0, 0}, {0, 0}, {0, 0}, {0, -3}, {0, -3}, {-2, 0}, {-2, 0}});
}

TEST_CASE("small is not zero: 1e-9 beside 1e6 is an eigenvalue, and so is a pair with a weak damping") {
  const Spectrum s = spectrum(similar({{1e6, 0, 0, 0}, {0, 1e-9, 0, 0}, {0, 0, -1e-12, 2}, {0, 0, -2, -1e-12}}));
  CHECK(s.zeros == 0);
  same(s, {{1e6, 0}, {1e-9, 0}, {-1e-12, 2}, {-1e-12, -2}});
}

TEST_CASE("a nilpotent matrix has zeros only, an empty one nothing") {
  CHECK(spectrum(matrix({{0, 1}, {0, 0}})).zeros == 2);
  CHECK(zero_eigenvalues(matrix({{0, 0}, {0, 0}})) == 2);
  CHECK(zero_eigenvalues(matrix({{0, 5}, {1, 0}})) == 0);
  CHECK(spectrum(Matrix<Precise>()).values.empty());
}

TEST_CASE("elimination tells the rank, a solution and the null space") {
  const Matrix<Precise> A = matrix({{1, 2, 3}, {2, 4, 6}, {1, 0, 1}});
  const Elimination<Precise> e(A, tiny<Precise>(30));
  CHECK(e.rank() == 2);
  const Matrix<Precise> N = e.null_space();
  REQUIRE(N.cols == 1);
  for (const Precise& x : (A * N).a) CHECK(magnitude(x) < tiny<Precise>(150));
  Matrix<Precise> b(3, 1);
  b(0, 0) = Precise(6), b(1, 0) = Precise(12), b(2, 0) = Precise(2);
  const Matrix<Precise> r = A * e.solve(b);
  for (std::size_t i = 0; i < 3; ++i) CHECK(magnitude(r(i, 0) - b(i, 0)) < tiny<Precise>(150));
}
