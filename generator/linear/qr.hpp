// SPDX-License-Identifier: GPL-3.0-or-later
// The QR algorithm in many digits, for real matrices without symmetry: balanced, reduced to Hessenberg form by
// reflections, double shifts. Backward stable: the results are eigenvalues of a matrix that differs from the given one
// in the last digits only. Source: Golub, Van Loan, Matrix Computations, sections 7.4, 7.5, 7.6.1 (inverse iteration).
#pragma once

#include <cln/complex.h>

#include "linear/dense.hpp"

namespace eomgen::linear {

/// D^-1 A D with powers of 2 on the diagonal of D, so that rows and columns have similar norms.
Matrix<Precise> balance(Matrix<Precise> A);

/// A root of the characteristic polynomial, and its conditioning.
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

/// The largest absolute row sum.
Precise infinity_norm(const Matrix<Precise>& A);

}  // namespace eomgen::linear
