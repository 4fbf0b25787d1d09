// SPDX-License-Identifier: GPL-3.0-or-later
// Solutions x of S x = r for many right-hand sides r with few nonzero entries, on expressions. S is symmetric and
// positive definite, and its graph is a tree or nearly one. For each r the rows are eliminated towards a root among its
// nonzero entries, so that rows without a right-hand side between them and the root are x_i = g_i x_next: one product.
// Eliminations towards different roots share what they have in common, since equal expressions are one.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "symbolic/factorisation.hpp"

namespace eomgen::program {

class RootedSolver {
 public:
  using Ref = symbolic::Ref;

  /// matrix: n x n row-major.
  RootedSolver(symbolic::Dag& dag, const std::vector<Ref>& matrix, std::size_t n);

  /// The sums of weights[i] x for each i, with r: n. An entry of `weights` has the weights of x by row.
  std::vector<Ref> operator()(const std::vector<Ref>& r, const std::vector<std::map<std::size_t, Ref>>& weights);

  /// Of all eliminations so far, each once.
  const std::vector<symbolic::Pivot>& pivots() const { return pivots_; }

 private:
  struct Step {
    std::size_t row;
    Ref pivot;
    std::vector<std::pair<std::size_t, Ref>> later;  // rows eliminated later, with the reduced entries
  };
  struct Elimination {
    std::vector<Step> steps;
    std::vector<std::size_t> step_of;  // per row
  };

  std::vector<std::size_t> distances(std::size_t from) const;
  /// The row next to all nonzero entries of r in one connected part of S, for every part that has any.
  std::vector<std::size_t> roots(const std::vector<Ref>& r) const;
  const Elimination& towards(const std::vector<std::size_t>& roots);
  Ref weighted(const Elimination& elimination, const std::vector<Ref>& z, const std::vector<Ref>& x,
               const std::map<std::size_t, Ref>& weights);

  symbolic::Dag& dag_;
  std::vector<std::map<std::size_t, Ref>> rows_;  // nonzero entries
  std::map<std::vector<std::size_t>, Elimination> eliminations_;
  std::vector<symbolic::Pivot> pivots_;
};

}  // namespace eomgen::program
