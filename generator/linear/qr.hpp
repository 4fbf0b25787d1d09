// SPDX-License-Identifier: GPL-3.0-or-later
// The QR algorithm in many digits, for real matrices without symmetry: balanced, brought to Hessenberg form by
// reflections, double shifts. Backward stable: what comes out are eigenvalues of a matrix that is the given one in all
// but the last digits. Source: Golub, Van Loan, Matrix Computations, sections 7.4, 7.5, 7.6.1 (inverse iteration).
#pragma once

#include <cln/complex.h>

#include "linear/dense.hpp"

namespace eomgen::linear {

/// D^-1 A D with powers of 2 on the diagonal of D, so that rows and columns are of like size.
Matrix<Precise> balanced(Matrix<Precise> A);

/// A root of the characteristic polynomial, and how well the matrix tells it.
struct Root {
  cln::cl_N value;
  Precise residual;   // |A x - value x| / |x| for the best x
  Precise condition;  // |y^H x| / (|x| |y|) of the left and right eigenvectors: small where a change of A moves the
                      // root far
};

struct Roots {
  std::vector<Root> list;
  bool complete = true;  // false: the iteration did not end, and some are missing
};

/// Of a balanced matrix, in no particular order.
Roots roots(const Matrix<Precise>& A);

/// The largest sum of a row.
Precise largest_row(const Matrix<Precise>& A);

}  // namespace eomgen::linear
