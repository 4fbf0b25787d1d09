// SPDX-License-Identifier: GPL-3.0-or-later
// Matrix decompositions in binary64. They are Eigen's, compiled only here because each takes the compiler seconds.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace eomgen::numeric {

/// The minimum-norm solution x of min |A x - b|, and the rank of A.
struct LeastSquares {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};

/// Solves min |A x - b|. A pivot counts as 0 up to `threshold` times the largest; by default, up to the rounding error.
LeastSquares least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold = {});

/// The rank, with the same criterion for pivots as least_squares.
Eigen::Index rank(const Eigen::MatrixXd& A, double threshold);

/// An orthonormal basis of the vectors that are orthogonal to the columns of A, with the same criterion.
Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& A, double threshold);

/// The vectors that A maps to 0 up to rounding as columns, not orthonormal (one column of zeros if there are none), and
/// the rank of A, by complete pivoting.
struct Kernel {
  Eigen::MatrixXd basis;
  Eigen::Index rank = 0;
};
Kernel kernel(const Eigen::MatrixXd& A);

/// Solves A x = b with a square A by complete pivoting. Without a threshold a singular A gives some x; with one, a
/// pivot up to `threshold` times the largest gives none.
Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
std::optional<Eigen::VectorXd> solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold);

/// The inverse of a square matrix by partial pivoting; not finite if A is singular.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

/// All right singular vectors as columns, by descending singular value.
Eigen::MatrixXd right_singular_vectors(const Eigen::MatrixXd& A);

/// The last pivot of a QR decomposition of A with exchanged columns relative to the largest, and its column of A. A has
/// at least as many rows as columns, and a column.
struct LastPivot {
  double relative = 1;
  Eigen::Index column = 0;
};
LastPivot last_pivot(const Eigen::MatrixXd& A);

/// Eigenvalues in Eigen's order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);
/// Eigenvalues of a symmetric matrix, ascending. Only the lower triangle is read.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& A);

}  // namespace eomgen::numeric
