// SPDX-License-Identifier: GPL-3.0-or-later
// In: an EquationSystem and a request. Out: the results of each function of the C ABI (docs/abi.md) as expressions of
// t, the state, parameters and inputs. The expressions are not optimised yet.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/friction.hpp"
#include "program/kinks.hpp"
#include "program/linear_solver.hpp"
#include "program/program.hpp"
#include "program/rooted_solver.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::program {

struct LabelledExpression {
  Ref value;
  std::string name, section;
};

/// The expressions of one Result.
struct ResultExpressions {
  std::string name;
  std::vector<Ref> entries;
  int code = 0;
};

struct FunctionExpressions {
  std::string name;
  std::vector<ResultExpressions> results;
  std::vector<Pivot> pivots;
  std::vector<LabelledExpression> labels;
};

/// Optimises expressions, and schedules them.
using MakeFunction = std::function<Function(const FunctionExpressions&)>;

struct ArrayProgram;

/// A function of the ABI with its result arguments, which have no entries yet.
FunctionExpressions empty_function(const char* name);

/// How derivatives of the accelerations are taken.
enum class Differentiate : std::uint8_t {
  equations,  // M dqddot = .. with qddot and lambda held: one factorisation more
  solution    // the solved accelerations
};

/// How the Jacobian matrix of values is made.
enum class Sweep : std::uint8_t {
  columns,  // forward: one right-hand side of the solve for each symbol
  rows      // reverse: one right-hand side of the solve for each value
};

/// Whether a function is a Jacobian matrix of `outputs`, `reactions` or `momenta`.
bool is_value_jacobian(const std::string& function);

/// Solves the equations of motion and builds the functions of the ABI from the solution.
class AbiFunctions {
 public:
  /// `fix`: values that replace parameters. `hold`: `mode` freezes the branches of kinks.
  AbiFunctions(system::EquationSystem system, const std::map<std::uint32_t, symbolic::Rational>& fix,
               Ties ties = Ties::ascending, bool hold = false);

  FunctionExpressions rhs();
  FunctionExpressions rhs_open();  // without forces of contacts
  FunctionExpressions power();
  FunctionExpressions jac();
  /// `jac` with loops over arrays; null if the formulation has none.
  std::shared_ptr<const ArrayProgram> jac_loops(const MakeFunction& make);
  FunctionExpressions jac_p(std::size_t parameters);
  FunctionExpressions jac_u(std::size_t inputs);
  /// Derivatives times the argument v (abi/functions.inc). Sources: Griewank and Walther, Evaluating Derivatives, 2008,
  /// chapter 3.
  FunctionExpressions jvp(Differentiate by);
  FunctionExpressions vjp(Differentiate by);
  FunctionExpressions adjoint(Differentiate by, std::size_t parameters, std::size_t inputs);
  FunctionExpressions hvp(Differentiate by);
  /// A function of which is_value_jacobian is true. `count`: of the parameters or inputs of its columns; of `columns`
  /// if it is a derivative by the state. `outputs`: those of `outputs`.
  FunctionExpressions value_jacobian(const std::string& name, const std::vector<std::string>& outputs,
                                     std::size_t count, Sweep sweep);
  /// Whether the system has all these outputs.
  bool has_outputs(const std::vector<std::string>& names) const;
  /// Whether derivatives by columns are made with the internal forces of a tree.
  bool has_forces() const { return m_ == 0 && system_.solution && system_.solution->forces; }
  /// M v - f without friction of contacts.
  FunctionExpressions inverse();
  FunctionExpressions coriolis();
  FunctionExpressions gravity();
  FunctionExpressions mass();
  FunctionExpressions constraints();
  /// dT/dqdot and its time derivative without constraint forces and contact friction.
  FunctionExpressions momenta();
  FunctionExpressions reactions();
  /// Throws Error with the list of known names if a name is unknown.
  FunctionExpressions outputs(const std::vector<std::string>& names);
  /// The events of the model, then the surfaces of the frozen kinks, then slip, above, below, hold and margin of each
  /// contact (friction.hpp).
  FunctionExpressions events();
  /// The array c of contacts whose forces are inputs (eom/contacts/description.hpp).
  FunctionExpressions contact_rows();
  /// Per event of the model, then per sample: its condition if it has one, then the values that it sets.
  FunctionExpressions resets();
  /// T, U and their derivatives by the free coordinates and their rates (energies.cpp).
  FunctionExpressions energy_gradients();

  const std::vector<Kink>& kinks() const { return kinks_; }

  const system::EquationSystem& system() const { return system_; }

 private:
  void add_solution(FunctionExpressions& function);
  void label_matrices(FunctionExpressions& function);
  std::vector<Ref> derivative_column(symbolic::Symbol along);
  /// d(qddot, rates of states) for the seeds of `d`; `along`: the symbol, if there is one only.
  std::vector<Ref> differentiated(symbolic::Derivation& d, std::optional<symbolic::Symbol> along);
  /// d(qddot) by the internal forces of a tree.
  std::vector<Ref> differentiated_forces(symbolic::Derivation& d);
  /// d(qddot, lambda) by the equations at fixed qddot and lambda.
  Unknowns differentiated_equations(symbolic::Derivation& d, std::optional<symbolic::Symbol> along);
  /// f + A^T lambda - M qddot, then gamma + A qddot, with qddot and lambda as symbols.
  std::vector<Ref> equation_sums();
  /// d(values)/d(symbols) by columns. The values may contain qddot and lambda as symbols.
  std::vector<Ref> value_slopes_by_columns(const std::vector<Ref>& values,
                                           const std::vector<symbolic::Symbol>& symbols);
  std::vector<Ref> value_slopes_by_rows(const std::vector<Ref>& values, const std::vector<symbolic::Symbol>& symbols);
  /// Values of outputs, in which qddot and lambda are symbols.
  std::vector<Ref> output_values(const std::vector<std::string>& names) const;
  bool contains_solution(Ref expression) const;
  bool differentiates_solution() const { return !system_.contacts.empty() || (system_.solution && m_ > 0); }
  std::vector<symbolic::Symbol> state_symbols() const;
  /// The gradient of v^T f by symbols, v = weights.
  std::vector<Ref> gradient(Differentiate by, const std::vector<Ref>& weights, const std::vector<symbolic::Symbol>& of);
  std::vector<Ref> arguments(std::size_t first, std::size_t count);
  /// Derivatives of an energy by the free coordinates (order 0) or their rates (order 1).
  std::vector<Ref> energy_slopes(Ref energy, std::uint8_t order);
  /// Expressions without the friction of contacts.
  std::vector<Ref> frictionless(const std::vector<Ref>& expressions);
  std::optional<std::vector<Ref>> solved_column(symbolic::Derivation& d, symbolic::Symbol along);
  Ref residual_slope(symbolic::Derivation& d, std::optional<symbolic::Symbol> along, std::size_t i);
  FunctionExpressions derivative_columns(const char* name, symbolic::SymbolKind kind, std::size_t count);
  /// Substitutes the solution for qddot and the active multipliers. Sets `solved` to true if the expression contains
  /// any of them.
  Ref substitute_solution(Ref expression, bool& solved);

  system::EquationSystem system_;
  std::vector<Kink> kinks_;
  std::vector<Ref> modeless_M_, modeless_f_, modeless_A_;  // for functions without a mode argument
  std::size_t n_, m_;
  std::vector<Ref> qdot_, qddot_symbol_, lambda_symbol_;
  void solve_contacts(std::map<symbolic::Symbol, Ref>& solution);
  const symbolic::VanishingNorms& norms();  // of the equations of motion, the rates of states and the outputs
  const LinearSolver& solve();              // created on first use; a system that is solved already may never need it

  Ties ties_ = Ties::ascending;
  std::unique_ptr<LinearSolver> solve_;
  std::unique_ptr<RootedSolver> force_solver_;             // created on first use
  std::vector<std::map<std::size_t, Ref>> force_weights_;  // d(qddot)/d(internal forces), by rows
  std::optional<symbolic::VanishingNorms> norms_;          // found on first use
  std::vector<Ref> qddot_, lambda_;
  std::unique_ptr<symbolic::Substitution> solution_;
  FrictionSolution friction_;  // if there are contacts
};

}  // namespace eomgen::program
