// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues of a matrix in many digits. Zeros are counted by ranks and split off; the others come from the QR
// algorithm, and each is held by its residual and against binary64 before it is given.
#pragma once

#include "linear/dense.hpp"

namespace eomgen::linear {

struct Eigenvalue {
  double re = 0, im = 0;
  double error = 0;         // estimated, in many digits: far below rounding but for large Jordan blocks
  bool in_binary64 = true;  // binary64's QR has one there, within what the matrix does to roundings
  /// Every printed digit stands for the matrix, and binary64 does not contradict.
  bool holds() const;
};

struct Spectrum {
  std::vector<Eigenvalue> values;  // with 0 as often as it is one; by falling real part, then imaginary part
  std::size_t zeros = 0;           // how often it is
  bool holds() const;
};

/// How many digits the entries of a matrix are known to, against its largest one.
inline constexpr int known_digits = 150;

Spectrum spectrum(const Matrix<Precise>& A, int known = known_digits);
/// Zeros alone.
std::size_t zero_eigenvalues(const Matrix<Precise>& A, int known = known_digits);

}  // namespace eomgen::linear
