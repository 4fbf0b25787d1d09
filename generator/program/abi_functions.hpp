// SPDX-License-Identifier: GPL-3.0-or-later
// In: EquationSystem and what is asked for. Out: the results of each function of the C ABI (docs/abi.md) as
// expressions of t, the state, parameters and inputs; nothing is optimised yet.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "program/friction.hpp"
#include "program/kinks.hpp"
#include "program/program.hpp"
#include "program/solve.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::program {

struct WantedLabel {
  Ref value;
  std::string name, section;
};

/// As Result has it.
struct WantedResult {
  std::string name;
  std::vector<Ref> entries;
  int code = 0;
};

struct WantedFunction {
  std::string name;
  std::vector<WantedResult> results;
  std::vector<Pivot> pivots;
  std::vector<WantedLabel> labels;
};

/// The equations of motion, solved, with what the functions of the ABI are made of.
class AbiFunctions {
 public:
  /// `fix`: parameters that become numbers; `hold`: `mode` holds the branches of kinks.
  AbiFunctions(system::EquationSystem system, const std::map<std::uint32_t, symbolic::Rational>& fix,
               Ties ties = Ties::ascending, bool hold = false);

  WantedFunction rhs();
  WantedFunction jac();
  WantedFunction jac_p(std::size_t parameters);
  WantedFunction mass();
  WantedFunction constraints();
  /// dT/dqdot, and its rate but for the forces of constraints; without friction of contacts.
  WantedFunction momenta();
  WantedFunction reactions();
  /// Throws Error with the names that exist where one is unknown.
  WantedFunction outputs(const std::vector<std::string>& names);
  /// The events of the model, then the surfaces of the kinks that are held, then slip, above, below, hold, margin of
  /// each contact (friction.hpp).
  WantedFunction events();

  const std::vector<Kink>& kinks() const { return kinks_; }

  const system::EquationSystem& system() const { return system_; }

 private:
  void add_solution(WantedFunction& function);
  void label_matrices(WantedFunction& function);
  std::vector<Ref> column(symbolic::Symbol along);
  /// qddot and the active multipliers written out; true in `solved` if there were any.
  Ref written_out(Ref expression, bool& solved);

  system::EquationSystem system_;
  std::vector<Kink> kinks_;
  std::vector<Ref> live_M_, live_f_, live_A_;  // of functions that have no mode
  std::size_t n_, m_;
  std::vector<Ref> qdot_, qddot_symbol_, lambda_symbol_;
  void close_contacts(std::map<symbolic::Symbol, Ref>& solution);
  const LinearSolve& solve();  // made when first needed: a system that is solved already may never ask

  Ties ties_ = Ties::ascending;
  std::unique_ptr<LinearSolve> solve_;
  std::vector<Ref> qddot_, lambda_;
  std::unique_ptr<symbolic::Substitution> solution_;
  FrictionSolution friction_;  // where there are contacts
};

}  // namespace eomgen::program
