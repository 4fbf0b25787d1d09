// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues of a matrix in many digits. Zeros are counted by ranks and split off. The others come from the QR
// algorithm; each is checked by its residual and against binary64.
#pragma once

#include "linear/dense.hpp"

namespace eomgen::linear {

struct Eigenvalue {
  double re = 0, im = 0;
  double error = 0;            // estimated in many digits: far below rounding except for large Jordan blocks
  bool is_in_binary64 = true;  // binary64's QR confirms it, within the condition of the matrix
  /// Whether every printed digit is correct and binary64 does not contradict.
  bool is_reliable() const;
};

struct Spectrum {
  std::vector<Eigenvalue> values;  // zeros with multiplicity; by falling real part, then imaginary part
  std::size_t zeros = 0;           // multiplicity of the eigenvalue 0
  bool is_reliable() const;
};

/// Known digits of a matrix's entries, relative to the largest one.
inline constexpr int known_digits = 150;

Spectrum spectrum(const Matrix<Precise>& A, int known = known_digits);
/// The multiplicity of the eigenvalue 0 alone.
std::size_t zero_eigenvalues(const Matrix<Precise>& A, int known = known_digits);

}  // namespace eomgen::linear
