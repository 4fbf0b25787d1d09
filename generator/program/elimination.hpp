// SPDX-License-Identifier: GPL-3.0-or-later
// Unrolled Gaussian elimination of a small unsymmetric matrix without pivoting. Structural zeros cost no operations.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::program {

/// Replaces each of `sides` (n) by the solution x of matrix x = side; matrix: n x n by rows.
inline void eliminate(symbolic::Dag& dag, std::vector<symbolic::Ref> matrix,
                      std::vector<std::vector<symbolic::Ref>>& sides) {
  const std::size_t n = sides.front().size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      if (dag.is_zero(matrix[i * n + k])) continue;
      const symbolic::Ref l = dag.div(matrix[i * n + k], matrix[k * n + k]);
      for (std::size_t j = k + 1; j < n; ++j)
        matrix[i * n + j] = dag.sub(matrix[i * n + j], dag.mul(l, matrix[k * n + j]));
      for (std::vector<symbolic::Ref>& side : sides) side[i] = dag.sub(side[i], dag.mul(l, side[k]));
    }
  }
  for (std::vector<symbolic::Ref>& side : sides) {
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t j = k + 1; j < n; ++j) side[k] = dag.sub(side[k], dag.mul(matrix[k * n + j], side[j]));
      side[k] = dag.div(side[k], matrix[k * n + k]);
    }
  }
}

}  // namespace eomgen::program
