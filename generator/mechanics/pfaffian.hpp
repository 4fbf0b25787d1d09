// SPDX-License-Identifier: GPL-3.0-or-later
// One-forms sum_i c_i dx_i in the free coordinates and t. Velocity constraints are f_i dq_i + b dt = 0. In:
// constraints. Out: their forms, elimination among them, and Frobenius' condition. Proven zeros are kept apart from
// numerical ones.
#pragma once

#include <cln/real.h>

#include <functional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {

using OneForm = std::vector<Ref>;  // coefficients of OneFormSpace::variables

/// The result of a test for an identical zero. `unknown`: there was no sample point, or the effort is used up.
enum class ZeroTestResult { proven, numerical, no, unknown };

/// Rows with a 1 in their pivot column and 0 in the pivot columns of the others.
struct Echelon {
  std::vector<OneForm> rows;
  std::vector<std::size_t> pivots;  // column of each row
  bool exact = true;                // every entry that was treated as 0 is proven to be 0
};

class OneFormSpace {
 public:
  /// The set of sample points: on the active holonomic constraints, or unrestricted.
  enum class SampleSet { on_constraints, unrestricted };
  explicit OneFormSpace(Mechanics& mechanics, SampleSet samples = SampleSet::on_constraints);

  Dag& dag() const { return dag_; }
  const std::vector<symbolic::Symbol>& variables() const { return variables_; }

  /// f . dq + b dt with eliminated coordinates imposed; functions of time and dependent parameters are expanded.
  OneForm one_form(const Constraint& constraint);
  OneForm differential(Ref psi);
  Ref impose_and_expand(Ref expression);
  /// df/dx of a variable. Integrals of functions of time have a rate.
  Ref derivative(Ref f, std::size_t variable);

  /// Tests values at a few points in 50 digits. If all are zero, tries a proof while effort remains.
  ZeroTestResult vanishing(Ref expression);
  /// Values at one of the sample points. Throws std::domain_error if there are none.
  std::vector<cln::cl_R> values(const std::vector<Ref>& expressions, std::size_t point) const;
  cln::cl_R value(const symbolic::Symbol& symbol, std::size_t point) const;
  std::size_t points() const { return points_.size(); }
  /// Drops the sample points at which an expression has no value. Returns the reason at the last of them, empty if all
  /// points are kept.
  std::string keep_points_with_values(const std::vector<Ref>& expressions);

  /// Whether the effort is used up. Later tests then return `unknown`, and eliminations end early.
  bool is_effort_spent() const { return effort_.left == 0; }

  /// Gauss-Jordan elimination. Only the first `columns` columns may hold pivots (0: all). Sets `exact`.
  Echelon echelon(std::vector<OneForm> rows, std::size_t columns = 0);
  /// The remainder of a form after subtraction of the rows of an echelon.
  OneForm reduce(OneForm form, const Echelon& rows);
  /// d omega_k modulo all rows, by row: one entry per pair of columns without pivot. All zero: integrable (Frobenius).
  std::vector<OneForm> curvature(const Echelon& rows);
  Ref simpler(Ref expression);

 private:
  using Values = std::function<cln::cl_R(const symbolic::Symbol&)>;
  bool move_onto_constraints(std::map<symbolic::Symbol, cln::cl_R>& point) const;
  bool choose_pivot(const std::vector<OneForm>& rows, const std::vector<bool>& used, std::size_t columns,
                    const std::vector<std::size_t>& pivots, std::pair<std::size_t, std::size_t>& at) const;

  Mechanics& m_;
  Dag& dag_;
  symbolic::Substitution imposed_, written_, parameters_;
  std::vector<symbolic::Symbol> variables_;
  std::vector<Ref> psi_;  // of the active holonomic constraints
  std::vector<OneForm> gradient_;
  std::vector<std::map<symbolic::Symbol, cln::cl_R>> points_;
  symbolic::ProductBudget effort_;  // of all proofs and simplifications together
};

/// Solves A x = b of few rows by elimination with complete pivoting. False if A is singular.
bool solve_small(const std::vector<std::vector<cln::cl_R>>& A, const std::vector<cln::cl_R>& b,
                 std::vector<cln::cl_R>& x);

}  // namespace eomgen::mechanics
