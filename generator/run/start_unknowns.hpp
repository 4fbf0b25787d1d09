// SPDX-License-Identifier: GPL-3.0-or-later
// The unknowns of a start that follow from constraints which do not determine all of them. In: the derivatives of the
// constraints by the unknowns, a column for each.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace eomgen::run {

/// Keeps only the changes of determined unknowns, which are the same for every solution; other entries of `move` become
/// 0. Returns false if there are none. `rank`: of the columns.
bool keep_determined(const Eigen::MatrixXd& columns, Eigen::Index rank, double tolerance, Eigen::VectorXd& move);

/// Selects as many unknowns as the constraints can determine: first those in `first`, then those with the largest
/// derivatives outside the span of the selected columns.
std::vector<bool> select_most_sensitive(Eigen::MatrixXd columns, const std::vector<bool>& first, double tolerance);

}  // namespace eomgen::run
