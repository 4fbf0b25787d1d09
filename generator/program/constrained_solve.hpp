// SPDX-License-Identifier: GPL-3.0-or-later
// In: EquationSystem with constraints A qddot = c. Out: M x = r + A^T lambda, A x = c solved without a Schur
// complement:
//   x = p + Z w with A Z = 0, A p = c,   (Z^T M Z) w = Z^T (r - M p),
// which is Maggi's and Kane's form for the accelerations (w are the rates of independent speeds, apart from Zdot), and
// with Z = [1; -A_d^-1 A_i] Chaplygin's and Voronets', where the dependent velocities are solved for (docs/theory.md).
// M may be singular as long as it is regular on the motions that the constraints leave.
#pragma once

#include <memory>

#include "program/solve.hpp"

namespace eomgen::program {

/// How the rows of A are solved: blocks of rows that share columns, each with as many dependent columns.
struct DependentBlock {
  std::vector<std::size_t> rows, dependent, independent;
  Ref determinant;  // of A[rows, dependent]
};

/// Nothing where a block is too large for its determinants to be written out.
std::optional<std::vector<DependentBlock>> dependent_blocks(const system::EquationSystem& system);

/// Whether the form exists for this system; `everywhere`: and holds wherever the constraints are independent.
bool form_applies(const system::EquationSystem& system, system::Form form, bool everywhere);

class ConstrainedSolve : public LinearSolve {
 public:
  ConstrainedSolve(const system::EquationSystem& system, Ties ties);

  Unknowns operator()(std::vector<Ref> r, const std::vector<Ref>& c) const override;
  Unknowns motion() const override;
  std::vector<Pivot> pivots() const override;

 private:
  void add_null_vectors(const DependentBlock& block, bool divided);
  std::vector<Ref> particular(const std::vector<Ref>& c) const;
  std::vector<Ref> multipliers(const std::vector<Ref>& excess) const;
  Ref simpler(Ref r) const;

  std::shared_ptr<Dag> dag_;
  std::size_t n_, m_;
  bool divided_;  // Chaplygin's form
  std::vector<Ref> M_, A_, f_, gamma_;
  std::vector<DependentBlock> blocks_;
  std::vector<std::vector<Ref>> adjugate_;         // per block, over its determinant if divided_
  std::vector<std::vector<Ref>> Z_;                // columns
  std::unique_ptr<Factorisation> reduced_, gram_;  // Z^T M Z; A A^T where the form is not divided
};

}  // namespace eomgen::program
