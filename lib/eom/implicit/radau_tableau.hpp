// SPDX-License-Identifier: MIT
// Radau IIA with s = 3, 5, 7 stages, orders 5, 9, 13, computed once in long double from its definition. Source: Hairer,
// Wanner, Solving Ordinary Differential Equations II, sections IV.3, IV.5 and IV.8.
//   c        the zeros of P_s(2x - 1) - P_(s-1)(2x - 1); the last is 1
//   A[i][j]  the integral of the j-th Lagrange polynomial up to c[i]
//   gamma, alpha +- i beta   the eigenvalues of A^-1: zeros of the denominator of the Pade approximation (s - 1, s) of
//            exp
//   T        transforms A^-1 to the block form [gamma, (alpha, -beta; beta, alpha), ...]. The first column has length
//            1. The last entries of the following columns are 1, 0.
//   node     1/(c[i] times the product of c[i] - c[j]), of Lagrange's polynomials with the additional node 0
//   slope    slope . Z = minus the derivative at 0 of the polynomial with value 0 at 0 and Z[i] at c[i]
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

namespace eom::implicit {

struct RadauTableau {
  static constexpr std::size_t most = 7;
  using Row = std::array<double, most>;
  std::size_t stages = 0;
  double gamma = 0;
  std::array<double, most / 2> alpha{}, beta{};
  Row c{}, node{}, slope{};
  std::array<Row, most> A{}, T{}, T_inverse{};

  /// For s = 3, 5 or 7.
  static const RadauTableau& of(std::size_t s) {
    if (s == 7) {
      static const RadauTableau seven(7);
      return seven;
    }
    static const RadauTableau three(3), five(5);
    return s == 3 ? three : five;
  }

 private:
  using Real = long double;
  using Number = std::complex<Real>;
  using Reals = std::array<Real, most + 1>;
  template <class Scalar>
  using Matrix = std::array<std::array<Scalar, most>, most>;

  explicit RadauTableau(std::size_t s) : stages(s) {
    const Reals nodes = find_nodes();
    Matrix<Real> a{};
    for (std::size_t j = 0; j < s; ++j) {
      const Reals l = lagrange(nodes, j);
      for (std::size_t i = 0; i < s; ++i)
        for (std::size_t k = s; k-- > 0;) a[i][j] = (a[i][j] + l[k] / static_cast<Real>(k + 1)) * nodes[i];
    }
    std::array<Number, most> roots = find_eigenvalues();
    Matrix<Real> t{}, inverse{};
    std::size_t pair = 0;
    for (std::size_t r = 0; r < s; ++r) {
      if (roots[r].imag() < -1e-9L) continue;
      const std::array<Number, most> v = eigenvector(a, roots[r]);
      const bool real = roots[r].imag() < 1e-9L;
      const std::size_t column = real ? 0 : 1 + 2 * pair;
      Real length = 0;
      for (std::size_t i = 0; i < s; ++i) length = std::hypot(length, v[i].real());
      for (std::size_t i = 0; i < s; ++i) {
        t[i][column] = v[i].real() / (real ? length : 1);
        if (!real) t[i][column + 1] = -v[i].imag();
      }
      if (real) {
        gamma = static_cast<double>(roots[r].real());
      } else {
        alpha[pair] = static_cast<double>(roots[r].real());
        beta[pair++] = static_cast<double>(roots[r].imag());
      }
    }
    for (std::size_t i = 0; i < s; ++i) inverse[i][i] = 1;
    solve(t, inverse, s);
    for (std::size_t i = 0; i < s; ++i) {
      c[i] = static_cast<double>(nodes[i]);
      slope[i] = static_cast<double>(-slope_at_start(nodes, i));
      Real product = nodes[i];
      for (std::size_t j = 0; j < s; ++j) product *= j == i ? 1 : nodes[i] - nodes[j];
      node[i] = static_cast<double>(1 / product);
      for (std::size_t j = 0; j < s; ++j) {
        A[i][j] = static_cast<double>(a[i][j]);
        T[i][j] = static_cast<double>(t[i][j]);
        T_inverse[i][j] = static_cast<double>(inverse[i][j]);
      }
    }
  }

  Real legendre_difference(Real x) const {
    Real before = 1, here = 2 * x - 1;
    for (std::size_t n = 2; n <= stages; ++n) {
      const Real next = (static_cast<Real>(2 * n - 1) * (2 * x - 1) * here - static_cast<Real>(n - 1) * before) /
                        static_cast<Real>(n);
      before = here;
      here = next;
    }
    return here - before;
  }

  /// Finds sign changes on a grid and bisects them to rounding; adds 1.
  Reals find_nodes() const {
    Reals nodes{};
    std::size_t found = 0;
    constexpr int grid = 1000;
    for (int k = 0; k + 1 < grid && found + 1 < stages; ++k) {
      Real low = static_cast<Real>(k) / grid, high = static_cast<Real>(k + 1) / grid;
      const bool positive = legendre_difference(low) > 0;
      if ((legendre_difference(high) > 0) == positive) continue;
      for (int halving = 0; halving < 70; ++halving) {
        const Real middle = (low + high) / 2;
        ((legendre_difference(middle) > 0) == positive ? low : high) = middle;
      }
      nodes[found++] = (low + high) / 2;
    }
    nodes[stages - 1] = 1;
    return nodes;
  }

  /// Coefficients of the j-th Lagrange polynomial on the nodes.
  Reals lagrange(const Reals& nodes, std::size_t j) const {
    Reals l{1};
    for (std::size_t k = 0, degree = 0; k < stages; ++k) {
      if (k == j) continue;
      for (std::size_t i = ++degree + 1; i-- > 0;)
        l[i] = ((i > 0 ? l[i - 1] : 0) - nodes[k] * l[i]) / (nodes[j] - nodes[k]);
    }
    return l;
  }

  /// Derivative at 0 of the polynomial with value 1 at node i and 0 at 0 and the other nodes.
  Real slope_at_start(const Reals& nodes, std::size_t i) const {
    Real slope_there = 1 / nodes[i];
    for (std::size_t k = 0; k < stages; ++k)
      if (k != i) slope_there *= nodes[k] / (nodes[k] - nodes[i]);
    return slope_there;
  }

  std::array<Number, most> find_eigenvalues() const {
    Reals q{1};  // sum of (-z)^j s!/((s - j)! j!) (2s - 1 - j)!/(2s - 1)!
    for (std::size_t j = 1; j <= stages; ++j)
      q[j] = -q[j - 1] * static_cast<Real>(stages - j + 1) / (static_cast<Real>(j) * static_cast<Real>(2 * stages - j));
    std::array<Number, most> z{};
    for (std::size_t i = 0; i < stages; ++i)
      z[i] = static_cast<Real>(stages) * std::polar<Real>(1, 2 * static_cast<Real>(i) + 0.4L);
    for (int round = 0; round < 500; ++round)  // Durand and Kerner
      for (std::size_t i = 0; i < stages; ++i) {
        Number value = q[stages];
        for (std::size_t j = stages; j-- > 0;) value = value * z[i] + q[j];
        for (std::size_t j = 0; j < stages; ++j)
          if (j != i) value /= z[i] - z[j];
        z[i] -= value / q[stages];
      }
    return z;
  }

  /// v with (1 - z A) v = 0 and last entry 1.
  std::array<Number, most> eigenvector(const Matrix<Real>& a, Number z) const {
    const std::size_t n = stages - 1;
    Matrix<Number> m{}, right{};
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) m[i][j] = (i == j ? Number(1) : Number(0)) - z * a[i][j];
      right[i][0] = z * a[i][n];
    }
    solve(m, right, n);
    std::array<Number, most> v{};
    for (std::size_t i = 0; i < n; ++i) v[i] = right[i][0];
    v[n] = 1;
    return v;
  }

  /// right = m^-1 right, by Gauss-Jordan elimination with pivots; m is a copy.
  template <class Scalar>
  static void solve(Matrix<Scalar> m, Matrix<Scalar>& right, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t best = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::abs(m[i][k]) > std::abs(m[best][k])) best = i;
      std::swap(m[k], m[best]);
      std::swap(right[k], right[best]);
      for (std::size_t i = 0; i < n; ++i) {
        if (i == k) continue;
        const Scalar factor = m[i][k] / m[k][k];
        for (std::size_t j = 0; j < most; ++j) m[i][j] -= factor * m[k][j], right[i][j] -= factor * right[k][j];
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < most; ++j) right[i][j] /= m[i][i];
  }
};

}  // namespace eom::implicit
