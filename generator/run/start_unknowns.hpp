// SPDX-License-Identifier: GPL-3.0-or-later
// Which unknowns of a start follow from constraints that do not fix them all. In: the slopes of the constraints by the
// unknowns, a column for each.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace eomgen::run {

/// Only those move that the constraints fix: what no motion of the rest changes; the entries of others in `move` become
/// 0. False where that is none. `rank`: of the columns.
bool keep_fixed(const Eigen::MatrixXd& columns, Eigen::Index rank, double tolerance, Eigen::VectorXd& move);

/// As many as the constraints can fix, those first that `first` names, then those with the largest slopes beside what
/// is taken already.
std::vector<bool> felt_most(Eigen::MatrixXd columns, const std::vector<bool>& first, double tolerance);

}  // namespace eomgen::run
