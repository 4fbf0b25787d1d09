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

/// Eigenvalues in Eigen's order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);
/// Eigenvalues of a symmetric matrix, ascending. Only the lower triangle is read.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& A);

}  // namespace eomgen::numeric
