// SPDX-License-Identifier: GPL-3.0-or-later
// Converts between the Dag, GiNaC and canonical sums. GiNaC differentiates and substitutes for the display form and
// factors small polynomials. None of its orderings or output leaves this stage.
#pragma once

#include <ginac/ginac.h>

#include <map>
#include <vector>

#include "reading/atom_table.hpp"

namespace eomgen::reading {

class GinacBridge {
 public:
  explicit GinacBridge(const mechanics::Mechanics& mechanics) : dag_(*mechanics.dag), atom_table_(*mechanics.model) {}

  GiNaC::ex from_dag(symbolic::Ref r);  // memoised over the Dag, iterative
  GiNaC::ex to_ginac(const Sum& sum);
  Sum from_ginac(const GiNaC::ex& e);  // expanded and simplified (trig.hpp); throws work::BudgetExceeded
  const GiNaC::symbol& symbol(const Symbol& symbol);
  AtomTable& atom_table() { return atom_table_; }

  Sum sum(symbolic::Ref r) { return from_ginac(from_dag(r)); }
  /// d/ds of a sum.
  Sum derivative(const Sum& sum, const Symbol& by);
  /// d/dt: q -> qdot -> qddot, functions of time likewise.
  Sum total_derivative(const Sum& sum);
  /// Derivative with respect to t at fixed coordinates and velocities.
  Sum explicit_derivative(const Sum& sum);
  Sum substitute(const Sum& sum, const std::map<Symbol, Sum>& values);

 private:
  Sum convert(const GiNaC::ex& e);
  Sum convert_power(const GiNaC::ex& e);
  Sum convert_function(const GiNaC::ex& e);
  GiNaC::ex node(symbolic::Ref r);
  GiNaC::ex term_to_ginac(const Monomial& monomial, const Rational& coefficient);

  const symbolic::Dag& dag_;
  AtomTable atom_table_;
  std::map<Symbol, GiNaC::ex> symbols_;  // as ex: copying a possymbol to a plain symbol would lose its sign
  std::map<GiNaC::ex, Symbol, GiNaC::ex_is_less> meaning_;
  std::map<symbolic::Ref, GiNaC::ex> nodes_;
  long steps_ = 0;  // of the current conversion: GiNaC traverses trees where the Dag shares nodes
};

/// A GiNaC function call. abs, sign, min, max and select are our own, with the derivatives of real functions (abs' =
/// sign).
GiNaC::ex ginac_call(Op function, const std::vector<GiNaC::ex>& args);
/// The operation of a GiNaC call; Op::symbol for a function that is not ours.
Op function_of(const GiNaC::function& f);

}  // namespace eomgen::reading
