// SPDX-License-Identifier: GPL-3.0-or-later
// Zero level lines of a function of three variables in slices of a box, by marching squares.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace eomgen::analysis {

using Field = std::function<double(const Eigen::VectorXd&)>;  // of 3 numbers; NaN where undefined

/// Level lines in the slice where coordinate k is `value`, each as an ordered list of points.
std::vector<std::vector<Eigen::VectorXd>> level_lines(const Field& f, const Eigen::VectorXd& low,
                                                      const Eigen::VectorXd& high, Eigen::Index k, double value);

/// Bounding box of the zero surface; nullopt if the surface extends beyond the given box.
std::optional<std::pair<Eigen::VectorXd, Eigen::VectorXd>> box_around(const Field& f, const Eigen::VectorXd& low,
                                                                      const Eigen::VectorXd& high);

}  // namespace eomgen::analysis
