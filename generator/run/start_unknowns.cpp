// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/start_unknowns.hpp"

#include "numeric/dense.hpp"

namespace eomgen::run {

using Eigen::Index;
using Eigen::MatrixXd;

bool keep_determined(const MatrixXd& columns, Index rank, double tolerance, Eigen::VectorXd& move) {
  const MatrixXd open = numeric::right_singular_vectors(columns).rightCols(columns.cols() - rank);
  bool any = false;
  for (Index i = 0; i < columns.cols(); ++i) {
    const bool fixed = open.row(i).norm() < tolerance;
    if (!fixed) move(i) = 0;
    any = any || fixed;
  }
  return any;
}

std::vector<bool> select_most_sensitive(MatrixXd columns, const std::vector<bool>& first, double tolerance) {
  std::vector<bool> taken(first.size(), false);
  const double least = tolerance * columns.norm();
  for (const bool named : {true, false}) {
    for (;;) {  // Gram-Schmidt with the longest remaining column each time
      Index longest = -1;
      for (Index i = 0; i < columns.cols(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (taken[k] || first[k] != named || !(columns.col(i).norm() > least)) continue;
        if (longest < 0 || columns.col(i).norm() > columns.col(longest).norm() * (1 + tolerance)) longest = i;
      }
      if (longest < 0) break;
      taken[static_cast<std::size_t>(longest)] = true;
      const Eigen::VectorXd direction = columns.col(longest).normalized();
      columns -= direction * (direction.transpose() * columns).eval();
    }
  }
  return taken;
}

}  // namespace eomgen::run
