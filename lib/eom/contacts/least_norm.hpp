// SPDX-License-Identifier: MIT
// Linear equations whose rows may depend on one another, such as those of the four corners of a box on a plane. In: a
// square matrix and a right-hand side. Out: the solution of least norm, in the least-squares sense; the rank.
//
// The equations of many contacts change little from one state to the next. With the pseudoinverse P of an earlier
// matrix W0, x += W' P' P (b - W x) converges by the factor |P (W - W0)|; x stays in the range of W', so that it is the
// solution of least norm.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace eom::contacts {

struct LeastNorm {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};

/// Scales rows and columns, so that forces and accelerations of different units count alike. Returns the factors of the
/// columns.
inline Eigen::VectorXd scale_rows_and_columns(Eigen::MatrixXd& A, Eigen::VectorXd& b) {
  Eigen::VectorXd columns = Eigen::VectorXd::Ones(A.cols());
  Eigen::VectorXd rows = A.cwiseAbs().rowwise().maxCoeff();
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    if (!(rows(i) > 0)) rows(i) = 1;
    b(i) /= rows(i);
  }
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    A.col(k).array() /= rows.array();
    const double size = A.col(k).norm();
    if (size > 0) columns(k) = 1 / size, A.col(k) /= size;
  }
  return columns;
}

inline constexpr double rank_tolerance = 1e-10;  // far above rounding, far below independent directions

inline LeastNorm solve_least_norm(Eigen::MatrixXd A, Eigen::VectorXd b) {
  const Eigen::Index n = A.cols();
  const Eigen::VectorXd columns = scale_rows_and_columns(A, b);
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

/// Solves for many states, one after the other.
class LeastNormSolver {
 public:
  /// The equations are others now.
  void reset() { inverse_.resize(0, 0); }

  LeastNorm solve(const Eigen::MatrixXd& W, const Eigen::VectorXd& right) {
    if (W.cols() < least_size) return solve_least_norm(W, right);
    A_ = W, b_ = right;
    const Eigen::VectorXd columns = scale_rows_and_columns(A_, b_);
    if (inverse_.cols() == A_.cols()) {
      if (const std::optional<Eigen::VectorXd> x = iterate()) return {columns.cwiseProduct(*x), rank_};
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(rank_tolerance);
    decomposition.compute(A_);
    rank_ = decomposition.rank();
    inverse_ = decomposition.pseudoInverse();
    return {columns.cwiseProduct(decomposition.solve(b_)), rank_};
  }

 private:
  static constexpr Eigen::Index least_size = 9;  // smaller equations are solved at once

  /// None: the matrix has changed too much, or the equations contradict one another.
  std::optional<Eigen::VectorXd> iterate() const {
    constexpr int most = 10;
    constexpr double slowest = 0.1, consistent = 1e-11, roundings = 16;
    constexpr double rounding = roundings * std::numeric_limits<double>::epsilon();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A_.cols()), left = b_;
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most; ++round) {
      const Eigen::VectorXd step = A_.transpose() * (inverse_.transpose() * (inverse_ * left));
      x += step;
      left.noalias() = b_ - A_ * x;
      const double moved = step.lpNorm<Eigen::Infinity>(), size = x.lpNorm<Eigen::Infinity>();
      if (!std::isfinite(moved)) return std::nullopt;
      const double residual = left.lpNorm<Eigen::Infinity>(), scale = b_.lpNorm<Eigen::Infinity>() + size;
      if (moved <= rounding * size || residual <= rounding * scale)
        return residual <= consistent * scale ? std::optional(x) : std::nullopt;
      if (moved > slowest * before) return std::nullopt;
      before = moved;
    }
    return std::nullopt;
  }

  Eigen::MatrixXd A_, inverse_;  // the equations; the pseudoinverse of earlier ones
  Eigen::VectorXd b_;
  Eigen::Index rank_ = 0;
};

}  // namespace eom::contacts
