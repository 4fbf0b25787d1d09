// SPDX-License-Identifier: GPL-3.0-or-later
// One-forms sum_i c_i dx_i in the free coordinates and t, of which constraints on velocities are made: f_i dq_i + b dt
// = 0. In: constraints. Out: their forms, elimination among them, and Frobenius' condition, with exact zeros told from
// those that only numbers show.
#pragma once

#include <cln/real.h>

#include <functional>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {

using Form = std::vector<Ref>;  // coefficients of FormSpace::variables

/// How it is known that something vanishes identically; `unknown`: there was no point at which to look, or no effort
/// left to do so.
enum class Vanishing { proven, at_points, no, unknown };

/// Rows with a 1 in their pivot column and 0 in the pivot columns of the others.
struct Echelon {
  std::vector<Form> rows;
  std::vector<std::size_t> pivots;  // column of each row
  bool exact = true;                // every entry that was taken for 0 is proven to be 0
};

class FormSpace {
 public:
  /// Whether points are taken on the active holonomic constraints.
  enum class Where { on_constraints, anywhere };
  explicit FormSpace(Mechanics& mechanics, Where where = Where::on_constraints);

  Dag& dag() const { return dag_; }
  const std::vector<symbolic::Symbol>& variables() const { return variables_; }

  /// f . dq + b dt with eliminated coordinates imposed, functions of time and dependent parameters written out.
  Form of(const Constraint& constraint);
  Form differential(Ref psi);
  Ref written(Ref expression);
  /// df/dx of a variable; integrals of functions of time have a rate.
  Ref derivative(Ref f, std::size_t variable);

  /// By values at a few points in 50 digits; then, if they vanish there, by proof, as long as the effort lasts.
  Vanishing vanishing(Ref expression);
  /// Values at one of the points; throws std::domain_error where there is none.
  std::vector<cln::cl_R> values(const std::vector<Ref>& expressions, std::size_t point) const;
  cln::cl_R value(const symbolic::Symbol& symbol, std::size_t point) const;
  std::size_t points() const { return points_.size(); }

  /// Whether the effort is used up; what is looked at from then on is unknown, and eliminations end early.
  bool spent() const { return effort_.left == 0; }

  /// Gauss-Jordan; columns of the first `columns` entries may hold pivots (0: all). Sets `exact`.
  Echelon echelon(std::vector<Form> rows, std::size_t columns = 0);
  /// What is left of a form after the rows of an echelon are subtracted.
  Form reduced(Form form, const Echelon& rows);
  /// d omega_k modulo all rows, by row: one entry per pair of columns without pivot. All zero: integrable (Frobenius).
  std::vector<Form> curvature(const Echelon& rows);
  Ref simpler(Ref expression);

 private:
  using Values = std::function<cln::cl_R(const symbolic::Symbol&)>;
  bool move_onto_constraints(std::map<symbolic::Symbol, cln::cl_R>& point) const;
  bool choose_pivot(const std::vector<Form>& rows, const std::vector<bool>& used, std::size_t columns,
                    const std::vector<std::size_t>& pivots, std::pair<std::size_t, std::size_t>& at) const;

  Mechanics& m_;
  Dag& dag_;
  symbolic::Substitution imposed_, written_, parameters_;
  std::vector<symbolic::Symbol> variables_;
  std::vector<Ref> psi_;  // of the active holonomic constraints
  std::vector<Form> gradient_;
  std::vector<std::map<symbolic::Symbol, cln::cl_R>> points_;
  symbolic::Effort effort_;  // of all proofs and simplifications together
};

/// x of A x = b in the sense of elimination with complete pivots, for a matrix of few rows; false where it is singular.
bool solve_small(const std::vector<std::vector<cln::cl_R>>& A, const std::vector<cln::cl_R>& b,
                 std::vector<cln::cl_R>& x);

}  // namespace eomgen::mechanics
