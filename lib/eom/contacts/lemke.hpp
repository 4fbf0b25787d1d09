// SPDX-License-Identifier: MIT
// Linear complementarity problems: w = M z + q, w >= 0, z >= 0, w . z = 0. In: M and q. Out: z, or the report that the
// method ends on a ray. Lemke's pivoting with the covering vector of ones and the lexicographic rule, which excludes
// cycles (Cottle, Pang and Stone, The Linear Complementarity Problem, 1992, section 4.4 and 4.9). For copositive-plus
// M, as of contacts without friction, a ray means that there is no solution.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace eom::contacts {

/// A solution z of w = M z + q, w >= 0, z >= 0, w z = 0.
struct ComplementaritySolution {
  bool found = false;  // false: the method ended on a ray, or after too many pivots
  Eigen::VectorXd z;
};

namespace lemke {

/// The dictionary w_B = .. in tableau form, with the columns of w (the lexicographic order needs its inverse), z, z0,
/// q.
class Tableau {
 public:
  using Index = Eigen::Index;

  Tableau(const Eigen::MatrixXd& M, const Eigen::VectorXd& q)
      : n_(q.size()), table_(n_, 2 * n_ + 2), basic_(static_cast<std::size_t>(n_)) {
    table_.leftCols(n_).setIdentity();
    table_.middleCols(n_, n_) = -M;
    table_.col(2 * n_).setConstant(-1);
    table_.col(2 * n_ + 1) = q;
    for (Index i = 0; i < n_; ++i) basic_[static_cast<std::size_t>(i)] = i;
  }

  Index covering() const { return 2 * n_; }
  Index complement(Index variable) const { return variable < n_ ? variable + n_ : variable - n_; }
  Index basic(Index row) const { return basic_[static_cast<std::size_t>(row)]; }
  double value(Index row) const { return table_(row, 2 * n_ + 1); }

  /// The row with the lexicographically least (right-hand side, row of the inverse) / pivot. z0 leaves in preference.
  std::optional<Index> leaving_row(Index entering) const {
    const double largest = table_.col(entering).lpNorm<Eigen::Infinity>();
    std::optional<Index> best;
    for (Index i = 0; i < n_; ++i) {
      if (!(table_(i, entering) > pivot_tolerance * std::max(1.0, largest))) continue;
      if (!best || precedes(i, *best, entering)) best = i;
    }
    if (!best) return best;
    for (Index i = 0; i < n_; ++i) {
      if (basic(i) == covering() && table_(i, entering) > pivot_tolerance * std::max(1.0, largest) &&
          ratio(i, entering) <= ratio(*best, entering) + ratio_tolerance)
        return i;
    }
    return best;
  }

  void pivot(Index row, Index entering) {
    table_.row(row) /= table_(row, entering);
    for (Index i = 0; i < n_; ++i) {
      if (i == row) continue;
      const double factor = table_(i, entering);
      if (factor != 0) table_.row(i) -= factor * table_.row(row);
      table_(i, entering) = 0;
    }
    table_(row, entering) = 1;
    basic_[static_cast<std::size_t>(row)] = entering;
  }

 private:
  static constexpr double pivot_tolerance = 1e-11, ratio_tolerance = 1e-13;

  double ratio(Index row, Index entering) const { return value(row) / table_(row, entering); }
  bool precedes(Index a, Index b, Index entering) const {
    const double of_a = ratio(a, entering), of_b = ratio(b, entering);
    if (std::abs(of_a - of_b) > ratio_tolerance) return of_a < of_b;
    for (Index k = 0; k < n_; ++k) {
      const double x = table_(a, k) / table_(a, entering), y = table_(b, k) / table_(b, entering);
      if (std::abs(x - y) > ratio_tolerance) return x < y;
    }
    return false;
  }

  Index n_;
  Eigen::MatrixXd table_;
  std::vector<Index> basic_;
};

/// Positive factors d such that the rows and columns of diag(d) M diag(d) have largest entries near 1 (Ruiz 2001).
/// They are powers of 2, so that scaling makes no rounding errors.
inline Eigen::VectorXd equilibrate(Eigen::MatrixXd M) {
  constexpr int rounds = 8;  // each takes the square root of what is left
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(M.rows());
  for (int round = 0; round < rounds; ++round) {
    Eigen::VectorXd step(M.rows());
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      const double size = std::max(M.row(i).lpNorm<Eigen::Infinity>(), M.col(i).lpNorm<Eigen::Infinity>());
      step(i) = size > 0 ? std::exp2(std::round(-std::log2(size) / 2)) : 1;
    }
    M = step.asDiagonal() * M * step.asDiagonal();
    factors = factors.cwiseProduct(step);
  }
  return factors;
}

}  // namespace lemke

/// `scaled_rows`: with positive factors d for w and 1/d for z, which change no solution. Then the tolerances of the
/// pivoting do not depend on units.
inline ComplementaritySolution solve_complementarity(const Eigen::MatrixXd& M, const Eigen::VectorXd& q,
                                                     bool scaled_rows = false) {
  using Index = Eigen::Index;
  const Index n = q.size();
  ComplementaritySolution result{true, Eigen::VectorXd::Zero(n)};
  if (n == 0 || q.minCoeff() >= 0) return result;
  const Eigen::VectorXd factors = scaled_rows ? lemke::equilibrate(M) : Eigen::VectorXd::Ones(n);
  Eigen::VectorXd scaled = factors.cwiseProduct(q);
  const double size = scaled.lpNorm<Eigen::Infinity>();
  scaled /= size;
  lemke::Tableau tableau(factors.asDiagonal() * M * factors.asDiagonal(), scaled);
  Index row = 0;
  scaled.minCoeff(&row);
  Index entering = tableau.covering();
  const Index most = 50 * (n + 1);
  for (Index count = 0;; ++count) {
    const Index leaves = tableau.basic(row);
    tableau.pivot(row, entering);
    if (leaves == tableau.covering()) break;
    entering = tableau.complement(leaves);
    const std::optional<Index> next = tableau.leaving_row(entering);
    if (!next || count == most) {
      result.found = false;
      return result;
    }
    row = *next;
  }
  for (Index i = 0; i < n; ++i) {
    const Index variable = tableau.basic(i);
    if (variable >= n && variable < 2 * n)
      result.z(variable - n) = std::max(0.0, tableau.value(i)) * size * factors(variable - n);
  }
  return result;
}

}  // namespace eom::contacts
