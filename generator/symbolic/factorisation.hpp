// SPDX-License-Identifier: GPL-3.0-or-later
// Symbolic L D L^T factorisation of a symmetric matrix of expressions. Structural zeros are skipped, and the minimum
// degree order of elimination preserves them.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// `pivot` is the value of `scale` after elimination. Emitted code returns 1 if it is negligible relative to `scale`.
struct Pivot {
  Ref pivot, scale;
};

/// The order of elimination among rows of equal degree.
enum class Ties { ascending, descending };

/// L D L^T of a symmetric matrix (row-major, n x n) with structural zeros.
class Factorisation {
 public:
  Factorisation(Dag& dag, std::vector<Ref> matrix, std::size_t n, Ties ties);

  /// L^-1 r, entries in the order of elimination.
  std::vector<Ref> forward(const std::vector<Ref>& r) const;
  /// L^-T D^-1 z, entries in the order of the rows.
  std::vector<Ref> backward(const std::vector<Ref>& z) const;
  /// sum_k a_k b_k / D_k for two results of `forward`.
  Ref inner(const std::vector<Ref>& a, const std::vector<Ref>& b) const;
  const std::vector<Pivot>& pivots() const { return pivots_; }

 private:
  std::size_t degree(const std::vector<bool>& done, std::size_t row) const;
  Dag& dag_;
  std::size_t n_;
  std::vector<Ref> w_;  // n x n, by rows of the matrix: reduced entries; below the diagonal of step k: l * D
  std::vector<std::size_t> order_;
  std::vector<Ref> d_;  // by step
  std::vector<Pivot> pivots_;
};

}  // namespace eomgen::symbolic
