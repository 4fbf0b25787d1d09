// SPDX-License-Identifier: MIT
// The complementarity problem of some contacts at a state: the rows that they restrict, the responses of velocities to
// unit forces along these rows, the laws of friction. Impacts and changes of modes build it alike.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/contacts/contact_forces.hpp"
#include "eom/contacts/friction_problem.hpp"

namespace eom::contacts {

class ContactProblem {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Kind = FrictionProblem::Kind;

  /// The rows and the free accelerations of `forces` are evaluated at (t, x); u has no contact forces.
  ContactProblem(ContactForces& forces, double t, const double* x, double* u) : forces_(forces), t_(t), x_(x), u_(u) {}

  /// A row with a unit force. Returns its index.
  Index add_row(std::size_t j, const Row& row, Pattern pattern, Kind kind) {
    rows_.push_back({&row, j});
    patterns_.push_back(std::move(pattern));
    problem_.kinds.push_back(kind);
    return static_cast<Index>(rows_.size()) - 1;
  }

  /// Friction at zero slip of contact j. `normal`: its row, or -1 if its normal force is given.
  void add_friction(std::size_t j, Index normal, double coefficient) {
    const Description& at = forces_.contact(j);
    FrictionLaw law{{}, normal, 1, 0, coefficient};
    if (normal < 0)
      law.given_normal = forces_.value(at.given_normal);
    else
      law.normal_sign = forces_.states()[j].normal_sign * forces_.value(at.normal_scale);
    for (std::size_t a = 0; a < at.slip.size(); ++a)
      law.tangents.push_back(add_row(j, at.slip[a], forces_.tangent_pattern(j, a), Kind::friction));
    problem_.laws.push_back(std::move(law));
    contact_of_law_.push_back(j);
  }

  /// The matrix of responses, to be called after the last row. Returns a code of the ABI.
  int complete() {
    const Index count = size();
    problem_.G.resize(count, count);
    problem_.q.resize(count);
    UnitResponses::Groups groups;
    if (const int code = forces_.responses(t_, x_, u_, patterns_, groups, responses_); code != 0) return code;
    for (Index k = 0; k < count; ++k)
      for (Index i = 0; i < count; ++i) problem_.G(i, k) = forces_.change(row(i), responses_.col(k));
    return 0;
  }

  FrictionProblem& problem() { return problem_; }
  Index size() const { return static_cast<Index>(rows_.size()); }
  const Row& row(Index i) const { return *rows_[static_cast<std::size_t>(i)].row; }
  std::size_t contact(Index i) const { return rows_[static_cast<std::size_t>(i)].contact; }
  /// The change of the accelerations, or of the rates, for a unit force along row i.
  auto response(Index i) const { return responses_.col(i); }
  Kind kind(Index i) const { return problem_.kinds[static_cast<std::size_t>(i)]; }
  const std::vector<std::size_t>& contact_of_law() const { return contact_of_law_; }

  /// The contact that approaches most: the one to name where there is no solution.
  std::size_t fastest_contact() const {
    if (size() == 0) return none;
    Index least = 0;
    problem_.q.minCoeff(&least);
    return contact(least);
  }

 private:
  struct Entry {
    const Row* row;
    std::size_t contact;
  };

  ContactForces& forces_;
  double t_;
  const double* x_;
  double* u_;
  FrictionProblem problem_;
  std::vector<Entry> rows_;
  std::vector<Pattern> patterns_;
  Eigen::MatrixXd responses_;  // n x rows
  std::vector<std::size_t> contact_of_law_;
};

}  // namespace eom::contacts
