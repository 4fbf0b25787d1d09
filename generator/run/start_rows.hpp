// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of a start, as rows: psi = 0 for positions (order 0), A qdot + b = target for rates (order 1). In: the
// equations and the current values, which are those of the StartProblem. Out: residuals and derivatives there.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "run/start.hpp"

namespace eomgen::run {

/// Steps, and residuals relative to their terms, below this (a few units in the last place) count as 0.
inline constexpr double start_rounding = 4e-16;

class StartRows {
 public:
  /// A contact of the system. Its row holds while it is closed.
  struct Contact {
    std::string name;
    std::optional<std::size_t> row;   // of its constraint
    bool unilateral = false;          // it can be open
    std::vector<symbolic::Ref> slip;  // per tangent
  };

  /// Rows of the active constraints, then of the redundant ones, then of contacts whose forces are inputs, then three
  /// for each given angular velocity.
  explicit StartRows(StartProblem& problem);

  /// Numbers of the rows of an order.
  const std::vector<std::size_t>& of_order(std::uint8_t order) const { return rows_[order]; }
  /// The number of the first row of the first given angular velocity.
  std::size_t first_angular_velocity_row() const { return psi_.size(); }
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// The constraint of the mechanics that a row before those of angular velocities imposes.
  std::size_t constraint_of(std::size_t row) const { return constraint_of_.at(row); }
  /// The rows as expressions: A (by rows), psi of the position constraints and b.
  const std::vector<symbolic::Ref>& A() const { return A_; }
  const std::vector<symbolic::Ref>& psi() const { return psi_; }
  const std::vector<symbolic::Ref>& b() const { return b_; }
  /// The contact whose slip each row that add_rolling appended makes 0.
  const std::vector<std::size_t>& rolling_contacts() const { return rolling_contacts_; }
  /// Removes a row from both orders.
  void drop(std::size_t number) {
    for (auto& rows : rows_) std::erase(rows, number);
  }
  /// Adds rows with slip 0 for bodies that roll with friction; returns whether there are any.
  bool add_rolling();
  void drop_rolling();

  /// The residuals of the rows, and their derivatives by the free coordinates or their rates.
  void linearise(std::uint8_t order, Eigen::VectorXd& residual, Eigen::MatrixXd& A) const;
  /// |residual_k| against the size of its linear terms: the relative measure of the contract.
  double relative(const Eigen::VectorXd& residual, const Eigen::MatrixXd& A, std::uint8_t order, Eigen::Index k) const;
  /// The largest of them, and its row.
  double largest_residual(std::uint8_t order, Eigen::Index* where = nullptr) const;

  double& value(StartProblem::Key key) { return (key.second == 0 ? p_.q : p_.qdot)[key.first]; }
  std::string label(StartProblem::Key key) const;
  /// Values of expressions at the current start.
  std::vector<double> evaluate(const std::vector<symbolic::Ref>& refs) const;

 private:
  void add_contacts();
  void add_angular_velocity(const StartProblem::AngularVelocity& turn);
  void add_rate(symbolic::Ref w, double wanted);
  double lookup(const symbolic::Symbol& s) const;

  StartProblem& p_;
  const system::EquationSystem& s_;
  std::size_t n_, m_;
  std::vector<symbolic::Ref> A_, psi_, b_;
  std::vector<Contact> contacts_;
  std::vector<std::size_t> constraint_of_;  // per row of psi_
  std::vector<std::size_t> rolling_contacts_;
  std::vector<double> target_;                    // of A qdot + b
  std::array<std::vector<std::size_t>, 2> rows_;  // order 0: position constraints; order 1: all constraints
};

}  // namespace eomgen::run
