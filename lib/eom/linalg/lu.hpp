// SPDX-License-Identifier: MIT
// Small dense linear systems: LU with partial pivoting, real or complex. In: a matrix by columns. Out: solutions.
// Allocates in the constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace eom {

/// A complex number whose products are four multiplications; std::complex checks for NaN in each of them.
struct Complex {
  double re = 0, im = 0;

  friend Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
  friend Complex operator/(Complex a, Complex b) {
    const double scale = std::abs(b.re) + std::abs(b.im);
    const Complex c{b.re / scale, b.im / scale};
    const double square = (c.re * c.re + c.im * c.im) * scale;
    return {(a.re * c.re + a.im * c.im) / square, (a.im * c.re - a.re * c.im) / square};
  }
  Complex& operator-=(Complex b) {
    re -= b.re;
    im -= b.im;
    return *this;
  }
};

/// LU factors of a square matrix, with partial pivoting.
template <class Scalar>
class Lu {
 public:
  explicit Lu(std::size_t n) : n_(n), a_(n * n), pivots_(n) {}

  /// Entry (i, j), to be set before factor(), which overwrites it.
  Scalar& operator()(std::size_t i, std::size_t j) { return a_[i + n_ * j]; }

  /// Returns false if the matrix is singular or not finite.
  bool factor() {
    for (std::size_t k = 0; k < n_; ++k) {
      std::size_t p = k;
      for (std::size_t i = k + 1; i < n_; ++i)
        if (size(a_[i + n_ * k]) > size(a_[p + n_ * k])) p = i;
      pivots_[k] = p;
      const Scalar pivot = a_[p + n_ * k];
      if (!(size(pivot) > 0) || !std::isfinite(size(pivot))) return false;
      if (p != k)
        for (std::size_t j = 0; j < n_; ++j) std::swap(a_[k + n_ * j], a_[p + n_ * j]);
      for (std::size_t i = k + 1; i < n_; ++i) a_[i + n_ * k] = a_[i + n_ * k] / pivot;
      for (std::size_t j = k + 1; j < n_; ++j) {
        const Scalar factor = a_[k + n_ * j];
        if (size(factor) == 0) continue;
        for (std::size_t i = k + 1; i < n_; ++i) a_[i + n_ * j] -= a_[i + n_ * k] * factor;
      }
    }
    return true;
  }

  /// Replaces b by the solution.
  void solve(Scalar* b) const {
    for (std::size_t k = 0; k < n_; ++k) std::swap(b[k], b[pivots_[k]]);
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t i = k + 1; i < n_; ++i) b[i] -= a_[i + n_ * k] * b[k];
    for (std::size_t k = n_; k-- > 0;) {
      b[k] = b[k] / a_[k + n_ * k];
      for (std::size_t i = 0; i < k; ++i) b[i] -= a_[i + n_ * k] * b[k];
    }
  }

 private:
  static double size(double value) { return std::abs(value); }
  static double size(Complex value) { return std::abs(value.re) + std::abs(value.im); }

  std::size_t n_;
  std::vector<Scalar> a_;
  std::vector<std::size_t> pivots_;
};

}  // namespace eom
