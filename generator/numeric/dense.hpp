// SPDX-License-Identifier: GPL-3.0-or-later
// Decompositions of matrices in binary64. They are Eigen's, compiled here once: each takes the compiler seconds.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace eomgen::numeric {

/// The shortest x of those for which |A x - b| is least, and the rank of A.
struct LeastSquares {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};

/// Pivots up to `threshold` of the largest count as 0; without one those that roundings may leave.
LeastSquares least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold = {});

/// By the same pivots.
Eigen::Index rank(const Eigen::MatrixXd& A, double threshold);

/// In Eigen's order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);
/// Ascending; of the lower triangle.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& A);

}  // namespace eomgen::numeric
