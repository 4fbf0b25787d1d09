// SPDX-License-Identifier: GPL-3.0-or-later
// In: EquationSystem with constraints A qddot = c. Out: the solution of M x = r + A^T lambda, A x = c without a Schur
// complement:
//   x = p + Z w with A Z = 0, A p = c,   (Z^T M Z) w = Z^T (r - M p).
// This is the acceleration form of Maggi's and Kane's equations (w: rates of independent speeds, without the term of
// Zdot). With Z = [1; -A_d^-1 A_i] it is Chaplygin's and Voronets' form, which is solved for the dependent velocities
// (docs/theory.md). M may be singular if it is regular on the null space of A.
#pragma once

#include <memory>

#include "program/linear_solver.hpp"

namespace eomgen::program {

/// A block of rows of A that share columns, with as many dependent columns.
struct DependentBlock {
  std::vector<std::size_t> rows, dependent, independent;
  Ref determinant;  // of A[rows, dependent]
};

/// Returns nothing if a block is too large to write out its determinants.
std::optional<std::vector<DependentBlock>> dependent_blocks(const system::EquationSystem& system);

/// Whether the form exists for this system; with `everywhere`, whether it also holds wherever the constraints are
/// independent.
bool is_form_applicable(const system::EquationSystem& system, system::Form form, bool everywhere);

class NullSpaceSolver : public LinearSolver {
 public:
  NullSpaceSolver(const system::EquationSystem& system, Ties ties);

  Unknowns operator()(std::vector<Ref> r, const std::vector<Ref>& c) const override;
  Unknowns solve_accelerations() const override;
  std::vector<Pivot> pivots() const override;

 private:
  void add_null_vectors(const DependentBlock& block, bool divided);
  std::vector<Ref> particular_solution(const std::vector<Ref>& c) const;
  std::vector<Ref> multipliers(const std::vector<Ref>& excess) const;
  Ref simplify_entry(Ref r) const;

  std::shared_ptr<Dag> dag_;
  std::size_t n_, m_;
  bool uses_quotients_;  // Chaplygin's form
  std::vector<Ref> M_, A_, f_, gamma_;
  std::vector<DependentBlock> blocks_;
  std::vector<std::vector<Ref>> adjugate_;         // per block, divided by its determinant if uses_quotients_
  std::vector<std::vector<Ref>> Z_;                // columns
  std::unique_ptr<Factorisation> reduced_, gram_;  // Z^T M Z; A A^T if not uses_quotients_
};

}  // namespace eomgen::program
