// SPDX-License-Identifier: GPL-3.0-or-later
// What a start has to satisfy, as rows: psi = 0 of positions (order 0), A qdot + b = wanted of rates (order 1). In: the
// equations and the values so far, which are those of the StartProblem. Out: residuals and slopes there.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "run/start.hpp"

namespace eomgen::run {

/// A step, or a residual beside its terms, that is below this many units in the last place is 0.
inline constexpr double start_rounding = 4e-16;

class StartRows {
 public:
  /// Those of the active constraints, then of redundant ones, then three for each given angular velocity.
  explicit StartRows(StartProblem& problem);

  /// Numbers of the rows of an order, in theirs.
  const std::vector<std::size_t>& of(std::uint8_t order) const { return rows_[order]; }
  /// The number of the first row of the first given angular velocity.
  std::size_t first_turn() const { return m_ + s_.redundant.size(); }
  /// Of both orders.
  void drop(std::size_t number) {
    for (auto& rows : rows_) std::erase(rows, number);
  }
  /// Slip 0 where something rolls by friction; whether anything does.
  bool add_rolling();
  void drop_rolling();

  /// The residuals of the rows, and their slopes by the free coordinates or their rates.
  void linearise(std::uint8_t order, Eigen::VectorXd& residual, Eigen::MatrixXd& A) const;
  /// |residual_k| against the size of its linear terms: the relative measure of the contract.
  double relative(const Eigen::VectorXd& residual, const Eigen::MatrixXd& A, std::uint8_t order, Eigen::Index k) const;
  /// The largest of them, and of which row.
  double worst(std::uint8_t order, Eigen::Index* where = nullptr) const;

  double& value(StartProblem::Key key) { return (key.second == 0 ? p_.q : p_.qdot)[key.first]; }
  std::string label(StartProblem::Key key) const;
  /// Of expressions, where the start is now.
  std::vector<double> evaluate(const std::vector<symbolic::Ref>& refs) const;

 private:
  void add_turn(const StartProblem::Turn& turn);
  void add_rate(symbolic::Ref w, double wanted);
  double lookup(const symbolic::Symbol& s) const;

  StartProblem& p_;
  const system::EquationSystem& s_;
  std::size_t n_, m_;
  std::vector<symbolic::Ref> A_, psi_, b_;
  std::vector<double> target_;                    // what A qdot + b is to be
  std::array<std::vector<std::size_t>, 2> rows_;  // constraints on positions (order 0), on velocities: all
};

}  // namespace eomgen::run
