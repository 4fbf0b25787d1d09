// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/spectrum.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

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

/// S J S^-1 with a full S of small integers.
Matrix<Precise> similar(const Rows& J) {
  const std::size_t n = J.size();
  Matrix<Precise> S(n, n), one(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    one(i, i) = Precise(1);
    for (std::size_t j = 0; j < n; ++j)
      S(i, j) = number<Precise>(Precise(static_cast<int>((3 * i * i + 7 * j + i * j) % 11) - 5 + (i == j ? 9 : 0)));
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

TEST_CASE("Jordan blocks are resolved: a triple 0, a double pair on the imaginary axis, a double -2") {
  const Spectrum s = spectrum(similar({{0, 1, 0, 0, 0, 0, 0, 0, 0},
                                       {0, 0, 1, 0, 0, 0, 0, 0, 0},
                                       {0, 0, 0, 0, 0, 0, 0, 0, 0},
                                       {0, 0, 0, 0, 3, 1, 0, 0, 0},
                                       {0, 0, 0, -3, 0, 0, 1, 0, 0},
                                       {0, 0, 0, 0, 0, 0, 3, 0, 0},
                                       {0, 0, 0, 0, 0, -3, 0, 0, 0},
                                       {0, 0, 0, 0, 0, 0, 0, -2, 1},
                                       {0, 0, 0, 0, 0, 0, 0, 0, -2}}));
  CHECK(s.zeros == 3);
  same(s, {{0, 3}, {0, 3}, {0, 0}, {0, 0}, {0, 0}, {0, -3}, {0, -3}, {-2, 0}, {-2, 0}});
}

TEST_CASE("small is not zero: 1e-9 beside 1e6 is an eigenvalue, and so is a weakly damped pair") {
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

namespace {

/// n masses in a row, each connected to the next: x'' = -K x / m - C x' / m with K and C of the same structure.
Matrix<Precise> chain(std::size_t n, double stiffness, double damping) {
  Matrix<Precise> A(2 * n, 2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    A(i, n + i) = Precise(1);
    for (std::size_t j = 0; j < n; ++j) {
      const int entry = i == j ? -2 : i + 1 == j || j + 1 == i ? 1 : 0;
      A(n + i, j) = number<Precise>(Precise(entry) * Precise(stiffness));
      A(n + i, n + j) = number<Precise>(Precise(entry) * Precise(damping));
    }
  }
  return A;
}

/// s^2 + w^2 c s + w^2 k = 0 with w^2 = 4 sin^2(j pi / (2 (n + 1))).
std::vector<Eigenvalue> chain_values(std::size_t n, double stiffness, double damping) {
  std::vector<Eigenvalue> result;
  for (std::size_t j = 1; j <= n; ++j) {
    const long double sine = std::sin(static_cast<long double>(j) * 3.14159265358979323846L /
                                      (2.0L * static_cast<long double>(n + 1))),
                      w2 = 4 * sine * sine;
    const long double half = w2 * damping / 2, root = half * half - w2 * stiffness;
    if (root < 0) {
      for (const long double im : {std::sqrt(-root), -std::sqrt(-root)})
        result.push_back({static_cast<double>(-half), static_cast<double>(im)});
    } else {
      const long double fast = -half - std::sqrt(root);
      result.push_back({static_cast<double>(fast), 0});
      result.push_back({static_cast<double>(w2 * stiffness / fast), 0});
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Eigenvalue& a, const Eigenvalue& b) { return a.re != b.re ? a.re > b.re : a.im > b.im; });
  return result;
}

}  // namespace

TEST_CASE("chains of springs and dampers: closed forms, undamped, damped, stiff, up to 60 states") {
  struct Case {
    std::size_t n;
    double stiffness, damping;
  };
  for (const Case& c : {Case{30, 100, 0}, Case{30, 3, 0.01}, Case{12, 1e8, 1}, Case{12, 1, 1e8}, Case{8, 1e-8, 1e4}}) {
    CAPTURE(c.stiffness);
    CAPTURE(c.damping);
    const Spectrum s = spectrum(chain(c.n, c.stiffness, c.damping));
    CHECK(s.zeros == 0);
    CHECK(s.is_reliable());
    same(s, chain_values(c.n, c.stiffness, c.damping));
  }
}

TEST_CASE("a Jordan block of size 12 gives one value, separate from another that differs by 1e-9") {
  Rows J(14, std::vector<double>(14, 0));
  for (std::size_t i = 0; i < 14; ++i) J[i][i] = i < 12 ? -2 : i == 12 ? -3 : -3 - 1e-9;
  for (std::size_t i = 0; i < 11; ++i) J[i][i + 1] = 1;
  const Spectrum s = spectrum(similar(J));
  REQUIRE(s.values.size() == 14);
  for (std::size_t i = 0; i < 12; ++i) {
    CHECK(s.values[i].re == doctest::Approx(-2).epsilon(1e-14));
    CHECK(s.values[i].im == 0);
  }
  CHECK(s.values[12].re == doctest::Approx(-3).epsilon(1e-15));
  CHECK(s.values[13].re == doctest::Approx(-3 - 1e-9).epsilon(1e-15));
  CHECK(s.values[12].re > s.values[13].re);
}

TEST_CASE("a hanging chain of particles: squares of its frequencies are zeros of Laguerre's polynomial times g/l") {
  // Joints in angles at rest, as energies: M_ij = min of masses below, K_ii = weight below; here in heights: x_i'' =
  // g/l ((n - i + 1) x_i+1 - ..).
  const std::size_t n = 10;
  Matrix<Precise> A(2 * n, 2 * n);
  for (std::size_t i = 0; i < n; ++i) {  // particle i counted from the free end, i strings' weight above it
    A(i, n + i) = Precise(1);
    A(n + i, i) = -Precise(static_cast<long>(2 * i + 1));
    if (i > 0) A(n + i, i - 1) = Precise(static_cast<long>(i));
    if (i + 1 < n) A(n + i, i + 1) = Precise(static_cast<long>(i + 1));
  }
  const Spectrum s = spectrum(A);
  // L_10's zeros (Abramowitz, Stegun, table 25.9).
  const double zeros[] = {29.920697012274, 21.996585811981, 16.279257831378, 11.843785837900, 8.330152746764,
                          5.552496140064,  3.401433697855,  1.808342901740,  0.729454549503,  0.137793470540};
  CHECK(s.is_reliable());
  for (std::size_t k = 0; k < n; ++k) {
    CHECK(s.values[k].re == 0);
    CHECK(s.values[k].im * s.values[k].im == doctest::Approx(zeros[k]).epsilon(1e-11));
  }
}

TEST_CASE("equal blocks give equal values without a spread: six critically damped oscillators") {
  Rows J(12, std::vector<double>(12, 0));
  for (std::size_t i = 0; i < 12; i += 2) J[i][i + 1] = 1, J[i + 1][i] = -4, J[i + 1][i + 1] = -4;
  const Spectrum s = spectrum(similar(J));
  CHECK(s.is_reliable());
  for (const Eigenvalue& e : s.values) {
    CHECK(e.re == doctest::Approx(-2).epsilon(1e-15));
    CHECK(e.im == 0);
  }
}

TEST_CASE("insufficient precision of 160 digits is reported: a Jordan block of size 40") {
  Rows J(40, std::vector<double>(40, 0));
  for (std::size_t i = 0; i < 40; ++i) {
    J[i][i] = -1;
    if (i + 1 < 40) J[i][i + 1] = 1;
  }
  const Spectrum s = spectrum(similar(J));
  CHECK(s.values.size() == 40);
  CHECK(!s.is_reliable());
}

TEST_CASE("elimination gives the rank, a solution and the null space") {
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
