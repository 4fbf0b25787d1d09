// SPDX-License-Identifier: GPL-3.0-or-later
#include "numeric/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace eomgen::numeric {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LeastSquares least_squares(const MatrixXd& A, const VectorXd& b, std::optional<double> threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  if (threshold) decomposition.setThreshold(*threshold);
  decomposition.compute(A);
  return {decomposition.solve(b), decomposition.rank()};
}

Eigen::Index rank(const MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> decomposition;
  decomposition.setThreshold(threshold);
  decomposition.compute(A);
  return decomposition.rank();
}

MatrixXd orthogonal_complement(const MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> decomposition;
  decomposition.setThreshold(threshold);
  decomposition.compute(A);
  const MatrixXd Q = decomposition.householderQ();
  return Q.rightCols(A.rows() - decomposition.rank());
}

Eigen::VectorXcd eigenvalues(const MatrixXd& A) { return Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues(); }

VectorXd symmetric_eigenvalues(const MatrixXd& A) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace eomgen::numeric
