// SPDX-License-Identifier: GPL-3.0-or-later
// In: EquationSystem. Out: its solution as expressions on the same Dag,
//   M qddot = f + A^T lambda,   A qddot = -gamma                              (docs/theory.md, index-1 form)
// by M = L D L^T, unrolled in an order that keeps the zeros of M, then
//   S lambda = -gamma - A M^-1 f,   S = A M^-1 A^T = Y^T D^-1 Y,   Y = L^-1 A^T.
// Structural zeros cost nothing; a diagonal M gives plain divisions. Where M alone is singular (a coordinate without
// mass) M + A^T A takes its place, with f - A^T gamma for f: on the constraints nothing changes.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::program {

using symbolic::Dag;
using symbolic::Ref;

/// `pivot` is what is left of `scale` after elimination; code 1 where it vanishes beside it.
struct Pivot {
  Ref pivot, scale;
};

/// Among rows of equally few entries in M: which one is eliminated first.
enum class Ties { ascending, descending };

/// L D L^T of a symmetric matrix (row-major, n x n) with structural zeros.
class Factorisation {
 public:
  Factorisation(Dag& dag, std::vector<Ref> matrix, std::size_t n, Ties ties);

  /// L^-1 r, in the order of elimination.
  std::vector<Ref> forward(const std::vector<Ref>& r) const;
  /// L^-T D^-1 z, in the order of the rows.
  std::vector<Ref> backward(const std::vector<Ref>& z) const;
  /// sum_k a_k b_k / D_k for two results of `forward`.
  Ref inner(const std::vector<Ref>& a, const std::vector<Ref>& b) const;
  const std::vector<Pivot>& pivots() const { return pivots_; }

 private:
  std::size_t next_row(std::vector<bool>& done, Ties ties);
  Dag& dag_;
  std::size_t n_;
  std::vector<Ref> w_;  // n x n, by rows of the matrix: reduced entries; below the diagonal of step k: l * D
  std::vector<std::size_t> order_;
  std::vector<Ref> d_;  // by step
  std::vector<Pivot> pivots_;
};

/// The solver of one EquationSystem for any right-hand side.
class Solve {
 public:
  explicit Solve(const system::EquationSystem& system, Ties ties = Ties::ascending);

  /// x, lambda of M x = r + A^T lambda, A x = c.
  std::pair<std::vector<Ref>, std::vector<Ref>> operator()(std::vector<Ref> r, const std::vector<Ref>& c) const;
  std::vector<Pivot> pivots() const;
  bool augmented() const { return augmented_; }

 private:
  std::shared_ptr<Dag> dag_;
  std::size_t n_, m_;
  std::vector<Ref> A_;
  bool augmented_ = false;
  std::unique_ptr<Factorisation> mass_, schur_;
  std::vector<std::vector<Ref>> Y_;
};

/// True where M has no inverse at any state: decided by values at a few points in high precision.
bool is_singular_everywhere(const Dag& dag, const std::vector<Ref>& M, std::size_t n);

}  // namespace eomgen::program
