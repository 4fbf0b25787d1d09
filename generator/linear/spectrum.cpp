// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/spectrum.hpp"

#include <cln/complex.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace eomgen::linear {
namespace {

using cln::cl_N;

// Coefficients and roots below these parts of what they could be are 0; the points are known to some 150 digits.
constexpr int rounding_digits = 90, zero_digits = 60, root_digits = 18, converged_digits = 26;
constexpr int most_rounds = 600;

// To Hessenberg form by eliminations with row pivots, which keeps the eigenvalues.
void to_hessenberg(Matrix<Precise>& A) {
  const std::size_t n = A.rows;
  for (std::size_t k = 1; k + 1 < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (magnitude(A(i, k - 1)) > magnitude(A(pivot, k - 1))) pivot = i;
    }
    if (is_zero(A(pivot, k - 1))) continue;
    for (std::size_t j = 0; j < n && pivot != k; ++j) std::swap(A(pivot, j), A(k, j));
    for (std::size_t j = 0; j < n && pivot != k; ++j) std::swap(A(j, pivot), A(j, k));
    for (std::size_t i = k + 1; i < n; ++i) {
      const Precise factor = A(i, k - 1) / A(k, k - 1);
      if (is_zero(factor)) continue;
      for (std::size_t j = 0; j < n; ++j) A(i, j) = A(i, j) - factor * A(k, j);
      for (std::size_t j = 0; j < n; ++j) A(j, k) = A(j, k) + factor * A(j, i);
    }
  }
}

Precise power(const Precise& x, std::size_t n) { return cln::expt(x, cln::cl_I(static_cast<unsigned long>(n))); }

Precise largest_row(const Matrix<Precise>& A) {
  Precise largest(0);
  for (std::size_t i = 0; i < A.rows; ++i) {
    Precise sum(0);
    for (std::size_t j = 0; j < A.cols; ++j) sum = sum + magnitude(A(i, j));
    largest = std::max(largest, sum);
  }
  return largest;
}

/// What cancels leaves a rounding of products of k entries; that is taken away. Returns the size of the largest root, but for a factor of
/// twice the degree: the largest |c_k|^(1/k).
double clean(std::vector<Precise>& c, const Matrix<Precise>& A) {
  const Precise norm = largest_row(A);
  double largest = 0;
  for (std::size_t k = 1; k < c.size(); ++k) {
    if (magnitude(c[k]) <= tiny<Precise>(rounding_digits) * power(norm, k)) c[k] = Precise(0);
    else largest = std::max(largest, std::exp(to_double(cln::ln(magnitude(c[k]))) / static_cast<double>(k)));
  }
  return largest;
}

std::size_t trailing_zeros(const std::vector<Precise>& c, double scale) {
  const auto vanishes = [&](std::size_t k) { return magnitude(c[k]) <= tiny<Precise>(zero_digits) * power(number<Precise>(Precise(scale)), k); };
  std::size_t zeros = 0;
  while (zeros + 1 < c.size() && vanishes(c.size() - 1 - zeros)) ++zeros;
  return zeros;
}

double larger_part(const cl_N& x) {
  return std::max(std::abs(cln::double_approx(cln::realpart(x))), std::abs(cln::double_approx(cln::imagpart(x))));
}

/// Where the search begins: binary64's eigenvalues, the smallest left out for the zeros, each a little beside its place.
std::vector<cl_N> guesses(const Matrix<Precise>& A, std::size_t zeros, double scale) {
  const auto n = static_cast<Eigen::Index>(A.rows);
  Eigen::MatrixXd M(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) M(i, j) = to_double(A(static_cast<std::size_t>(i), static_cast<std::size_t>(j)));
  }
  const Eigen::VectorXcd found = Eigen::EigenSolver<Eigen::MatrixXd>(M, false).eigenvalues();
  std::vector<std::complex<double>> all(found.data(), found.data() + found.size());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  std::vector<cl_N> result;
  for (std::size_t k = 0; k + zeros < all.size(); ++k) {
    const double size = std::max(std::abs(all[k]), 1e-8 * scale), angle = 2.4 * static_cast<double>(k) + 0.7;
    const std::complex<double> z = all[k] + 1e-6 * size * std::complex<double>(std::cos(angle), std::sin(angle));
    result.push_back(cln::complex(cln::cl_float(z.real(), precise_format()), cln::cl_float(z.imag(), precise_format())));
  }
  return result;
}

// All roots together (Ehrlich and Aberth): simple ones with third order, multiple ones linearly.
void find_roots(const std::vector<Precise>& c, std::vector<cl_N>& z) {
  const double enough = std::pow(10.0, -converged_digits);
  for (int round = 0; round < most_rounds; ++round) {
    bool still = true;
    for (std::size_t k = 0; k < z.size(); ++k) {
      cl_N p = c[0], d = cl_N(0);
      for (std::size_t i = 1; i <= z.size(); ++i) {
        d = d * z[k] + p;
        p = p * z[k] + c[i];
      }
      if (cln::zerop(p)) continue;
      cl_N repulsion = 0;
      for (std::size_t j = 0; j < z.size(); ++j) {
        if (j != k && !cln::zerop(z[k] - z[j])) repulsion = repulsion + cl_N(1) / (z[k] - z[j]);
      }
      const cl_N below = d - p * repulsion;
      if (cln::zerop(below)) continue;
      const cl_N step = p / below;
      z[k] = z[k] - step;
      still = still && larger_part(step) <= enough * larger_part(z[k]);
    }
    if (still) return;
  }
}

// The polynomial is real: what rounding has told apart is made conjugate again.
void pair_up(std::vector<Eigenvalue>& values) {
  for (const Eigenvalue& a : values) {
    if (!(a.im > 0)) continue;
    const auto distance = [&a](const Eigenvalue& b) { return b.im < 0 ? std::hypot(a.re - b.re, a.im + b.im) : HUGE_VAL; };
    const auto partner = std::min_element(values.begin(), values.end(),
                                          [&](const Eigenvalue& x, const Eigenvalue& y) { return distance(x) < distance(y); });
    if (distance(*partner) <= 1e-12 * std::hypot(a.re, a.im)) *partner = {a.re, -a.im};
  }
}

}  // namespace

std::vector<Precise> characteristic_polynomial(Matrix<Precise> H) {
  to_hessenberg(H);
  const std::size_t n = H.rows;
  // p_k of the leading k x k block, lowest power first.
  std::vector<std::vector<Precise>> p{{Precise(1)}};
  for (std::size_t k = 1; k <= n; ++k) {
    std::vector<Precise> next(k + 1, Precise(0));
    for (std::size_t i = 0; i < k; ++i) {
      next[i + 1] = next[i + 1] + p[k - 1][i];
      next[i] = next[i] - H(k - 1, k - 1) * p[k - 1][i];
    }
    Precise below(1);
    for (std::size_t i = 1; i < k; ++i) {
      below = below * H(k - i, k - i - 1);
      if (is_zero(below)) break;
      const Precise factor = below * H(k - i - 1, k - 1);
      for (std::size_t j = 0; j < p[k - i - 1].size(); ++j) next[j] = next[j] - factor * p[k - i - 1][j];
    }
    p.push_back(std::move(next));
  }
  return {p[n].rbegin(), p[n].rend()};
}

std::size_t zero_eigenvalues(const Matrix<Precise>& A) {
  std::vector<Precise> c = characteristic_polynomial(A);
  const double scale = clean(c, A);
  return trailing_zeros(c, scale);
}

Spectrum spectrum(const Matrix<Precise>& A) {
  Spectrum result;
  std::vector<Precise> c = characteristic_polynomial(A);
  const double scale = clean(c, A);
  result.zeros = trailing_zeros(c, scale);
  c.resize(c.size() - result.zeros);
  std::vector<cl_N> z;
  if (c.size() > 1) {
    z = guesses(A, result.zeros, scale);
    find_roots(c, z);
  }
  for (const cl_N& root : z) {
    Eigenvalue value{cln::double_approx(cln::realpart(root)), cln::double_approx(cln::imagpart(root))};
    const double size = std::hypot(value.re, value.im) * std::pow(10.0, -root_digits);
    if (std::abs(value.re) <= size) value.re = 0;
    if (std::abs(value.im) <= size) value.im = 0;
    result.values.push_back(value);
  }
  pair_up(result.values);
  result.values.resize(result.values.size() + result.zeros);
  std::stable_sort(result.values.begin(), result.values.end(),
                   [](const Eigenvalue& a, const Eigenvalue& b) { return a.re != b.re ? a.re > b.re : a.im > b.im; });
  return result;
}

}  // namespace eomgen::linear
