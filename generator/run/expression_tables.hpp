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

/// The meaning of a symbol: a number, a parameter, the index of a variable, another expression; or unknown, if it
/// cannot be evaluated.
struct Leaf {
  enum class Kind { number, parameter, variable, expression, unknown } kind = Kind::unknown;
  double number = 0;
  std::size_t index = 0;
  symbolic::Ref expression{};

  static Leaf of(double value) { return {Kind::number, value, 0, {}}; }
  static Leaf of_parameter(std::size_t index) { return {Kind::parameter, 0, index, {}}; }
  static Leaf of_variable(std::size_t index) { return {Kind::variable, 0, index, {}}; }
  static Leaf of_expression(symbolic::Ref e) { return {Kind::expression, 0, 0, e}; }
};
using Lookup = std::function<Leaf(const symbolic::Symbol&)>;

/// The table of the roots; nothing if a symbol cannot be evaluated.
std::optional<Table> table_of(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots, const Lookup& lookup);

/// The variables of a run (eom/hybrid/problem.hpp): t, free coordinates, their rates, integrals, inputs.
Lookup variables_of(const system::EquationSystem& system);

}  // namespace eomgen::run
