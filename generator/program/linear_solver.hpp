// SPDX-License-Identifier: GPL-3.0-or-later
// In: EquationSystem. Out: its solution as expressions on the same Dag,
//   M qddot = f + A^T lambda,   A qddot = -gamma                              (docs/theory.md, index-1 form)
// by M = L D L^T, unrolled in an order that preserves the zeros of M, then
//   S lambda = -gamma - A M^-1 f,   S = A M^-1 A^T = Y^T D^-1 Y,   Y = L^-1 A^T.
// Structural zeros cost no operations; a diagonal M gives plain divisions. If the system has QuasiVelocityEquations,
// their matrix is factorised: M^-1 = S^-1 M_theta^-1 S^-T. If only M is singular (a massless coordinate, Euler
// parameters), M
// + A^T S A replaces M and f - A^T S gamma replaces f, which changes nothing on the constraints. If sufficient, only
// the rows of A that constrain a singular block of M alone are used, so that bodies with coordinates of their own stay
// decoupled. S is diagonal and scaled to M, so that small terms are not lost in the sum. An open contact has a zero row
// in A and a 1 on the diagonal of the Schur complement, so that its lambda is 0.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "symbolic/factorisation.hpp"
#include "system/equation_system.hpp"

namespace eomgen::program {

using symbolic::Dag;
using symbolic::Ref;

using symbolic::Factorisation;
using symbolic::Pivot;
using symbolic::Ties;

/// x and lambda.
using Unknowns = std::pair<std::vector<Ref>, std::vector<Ref>>;

/// The solver of one EquationSystem in one of the forms.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// x, lambda of M x = r + A^T lambda, A x = c.
  virtual Unknowns operator()(std::vector<Ref> r, const std::vector<Ref>& c) const = 0;
  /// qddot and lambda of the equations of motion.
  virtual Unknowns solve_accelerations() const = 0;
  virtual std::vector<Pivot> pivots() const = 0;
};

/// Selects the solver by system.form.
std::unique_ptr<LinearSolver> make_linear_solver(const system::EquationSystem& system, Ties ties);

/// Solves one EquationSystem for any right-hand side by LDL^T factorisation.
class LdlSolver : public LinearSolver {
 public:
  explicit LdlSolver(const system::EquationSystem& system, Ties ties = Ties::ascending);

  Unknowns operator()(std::vector<Ref> r, const std::vector<Ref>& c) const override;
  Unknowns solve_accelerations() const override;
  std::vector<Pivot> pivots() const override;
  bool augmented() const { return augmented_; }

 private:
  void augment(std::vector<Ref>& M, const std::vector<bool>& taken);
  Ref constraint_scale(const std::vector<Ref>& M, std::size_t c) const;
  std::vector<Ref> forward(const std::vector<Ref>& r) const;
  std::vector<Ref> backward(const std::vector<Ref>& z) const;
  std::pair<std::vector<Ref>, std::vector<Ref>> solve_from_forward(std::vector<Ref> z, const std::vector<Ref>& c) const;

  std::shared_ptr<Dag> dag_;
  std::size_t n_, m_;
  std::vector<Ref> A_, f_, gamma_;
  std::optional<system::QuasiVelocityEquations> quasi_;
  bool augmented_ = false;
  std::vector<Ref> S_;  // per constraint, if augmented; 0 for unused constraints
  std::unique_ptr<Factorisation> mass_, schur_;
  std::vector<std::vector<Ref>> Y_;
};

/// Whether M is singular at every state. Decided by high-precision values at a few points.
bool is_singular_everywhere(const Dag& dag, const std::vector<Ref>& M, std::size_t n);

}  // namespace eomgen::program
