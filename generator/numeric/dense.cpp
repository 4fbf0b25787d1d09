// SPDX-License-Identifier: GPL-3.0-or-later
#include "numeric/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

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

Kernel kernel(const MatrixXd& A) {
  const Eigen::FullPivLU<MatrixXd> lu(A);
  return {lu.kernel(), lu.rank()};
}

VectorXd solve(const MatrixXd& A, const VectorXd& b) { return Eigen::FullPivLU<MatrixXd>(A).solve(b); }

std::optional<VectorXd> solve(const MatrixXd& A, const VectorXd& b, double threshold) {
  Eigen::FullPivLU<MatrixXd> lu(A);
  lu.setThreshold(threshold);
  if (!lu.isInvertible()) return std::nullopt;
  return lu.solve(b);
}

MatrixXd inverse(const MatrixXd& A) { return Eigen::PartialPivLU<MatrixXd>(A).inverse(); }

MatrixXd right_singular_vectors(const MatrixXd& A) {
  return Eigen::JacobiSVD<MatrixXd>(A, Eigen::ComputeFullV).matrixV();
}

LastPivot last_pivot(const MatrixXd& A) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  const Eigen::Index last = A.cols() - 1;
  return {std::abs(qr.matrixQR()(last, last)) / std::max(qr.maxPivot(), 1e-300), qr.colsPermutation().indices()(last)};
}

Eigen::VectorXcd eigenvalues(const MatrixXd& A) { return Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues(); }

VectorXd symmetric_eigenvalues(const MatrixXd& A) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace eomgen::numeric
