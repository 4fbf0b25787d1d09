// SPDX-License-Identifier: GPL-3.0-or-later
// Where a function of three numbers vanishes in a box: lines in a slice, by marching squares.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace eomgen::analysis {

using Field = std::function<double(const Eigen::VectorXd&)>;  // of three numbers; not-a-number where it has no value

/// Lines across coordinate k at `value`, each as points in their order.
std::vector<std::vector<Eigen::VectorXd>> level_lines(const Field& f, const Eigen::VectorXd& low,
                                                      const Eigen::VectorXd& high, Eigen::Index k, double value);

/// The box around the surface, if it ends within this one.
std::optional<std::pair<Eigen::VectorXd, Eigen::VectorXd>> box_around(const Field& f, const Eigen::VectorXd& low,
                                                                      const Eigen::VectorXd& high);

}  // namespace eomgen::analysis
