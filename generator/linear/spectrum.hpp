// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues of a matrix in many digits: the characteristic polynomial, its roots at 0 counted by its last coefficients, the
// others found together. Multiple ones stay what they are, where binary64 would spread a Jordan block.
#pragma once

#include "linear/dense.hpp"

namespace eomgen::linear {

struct Eigenvalue {
  double re = 0, im = 0;
};

struct Spectrum {
  std::vector<Eigenvalue> values;  // with 0 as often as it is one; by falling real part, then imaginary part
  std::size_t zeros = 0;           // how often it is
};

/// Leading coefficient first: 1, c1, ..., cn.
std::vector<Precise> characteristic_polynomial(Matrix<Precise> A);

Spectrum spectrum(const Matrix<Precise>& A);
/// Zeros alone.
std::size_t zero_eigenvalues(const Matrix<Precise>& A);

}  // namespace eomgen::linear
