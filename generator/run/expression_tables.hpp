// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions as data that a run evaluates itself. In: expressions on a Dag and the meaning of their symbols. Out:
// tables of the runtime (eom/expressions/code.hpp).
#pragma once

#include <eom/expressions/code.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "symbolic/dag.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

using eom::expressions::Table;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// The meaning of a symbol: a number, a parameter, the index of a variable, another expression; or unknown, if it
/// cannot be evaluated.
struct SymbolMeaning {
  enum class Kind { number, parameter, variable, expression, unknown } kind = Kind::unknown;
  double number = 0;
  std::size_t index = 0;
  symbolic::Ref expression{};

  static SymbolMeaning of(double value) { return {Kind::number, value, 0, {}}; }
  static SymbolMeaning of_parameter(std::size_t index) { return {Kind::parameter, 0, index, {}}; }
  static SymbolMeaning of_variable(std::size_t index) { return {Kind::variable, 0, index, {}}; }
  static SymbolMeaning of_expression(symbolic::Ref e) { return {Kind::expression, 0, 0, e}; }
};
using SymbolResolver = std::function<SymbolMeaning(const symbolic::Symbol&)>;

/// The table of the roots; nothing if a symbol cannot be evaluated.
std::optional<Table> make_table(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots,
                                const SymbolResolver& lookup);

/// The variables of a run (eom/hybrid/problem.hpp): t, free coordinates, their rates, states of first order, inputs.
SymbolResolver run_variables(const system::EquationSystem& system);

}  // namespace eomgen::run
