// SPDX-License-Identifier: MIT
// Linear equations whose rows may depend on one another, such as those of the four corners of a box on a plane. In: a
// square matrix and a right-hand side. Out: the solution of least norm, in the least-squares sense; the rank.
#pragma once

#include <Eigen/Dense>
#include <cstddef>

namespace eom::contacts {

struct LeastNorm {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};

/// Rows and columns are scaled before, so that forces and accelerations of different units count alike.
inline LeastNorm solve_least_norm(Eigen::MatrixXd A, Eigen::VectorXd b) {
  constexpr double rank_tolerance = 1e-10;  // far above rounding, far below independent directions
  const Eigen::Index n = A.cols();
  Eigen::VectorXd columns = Eigen::VectorXd::Ones(n);
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const double size = A.row(i).lpNorm<Eigen::Infinity>();
    if (size > 0) A.row(i) /= size, b(i) /= size;
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const double size = A.col(k).norm();
    if (size > 0) columns(k) = 1 / size, A.col(k) /= size;
  }
  if (n <= 3) {  // most often; the pivoted elimination is exact enough if it is regular
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    if (lu.maxPivot() > 0 && std::abs(lu.matrixLU()(n - 1, n - 1)) > rank_tolerance * lu.maxPivot())
      return {columns.cwiseProduct(lu.solve(b)), n};
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(rank_tolerance);
  decomposition.compute(A);
  return {columns.cwiseProduct(decomposition.solve(b)), decomposition.rank()};
}

}  // namespace eom::contacts
