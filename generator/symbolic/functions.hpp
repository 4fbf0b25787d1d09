// SPDX-License-Identifier: GPL-3.0-or-later
// The table of the functions of the graph: number of arguments, symmetry, value at 0, and names in the model language
// and in the targets. The rules of the graph, printing, emission and operation counts use it. Derivatives and values in
// binary64 are those of the runtime (eom/expressions/operations.hpp). The oracle has a table of its own, so that it can
// detect errors here.
#pragma once

#include <array>
#include <cstdint>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

enum class Parity : std::uint8_t { none, even, odd };

using eom::expressions::Slope;

struct Function {
  Op op;
  std::uint8_t arity;
  const char* name;            // in the model language
  const char* code;            // in C, C++, CUDA, JavaScript and Python; null: expanded
  const char *latex, *mathml;  // empty: a notation of its own
  Parity parity = Parity::none;
  int at_zero = -1;     // f(0): 0 or 1; -1: unknown
  bool raised = false;  // powers are printed at the name: sin^2 x

  // dv/dx, from the table of the runtime.
  constexpr eom::expressions::Derivative derivative() const { return derivative_of(runtime_op(op)); }
  constexpr Slope slope() const { return derivative().form; }
  constexpr bool falls() const { return derivative().falls; }          // the derivative is minus `slope`
  constexpr Op other() const { return graph_op(derivative().other); }  // of Slope::other
};

/// The functions in the order of Op, from Op::pow on.
inline constexpr std::array<Function, 19> function_table{{
    {Op::pow, 2, "^", "pow", "", ""},
    {Op::sqrt, 1, "sqrt", "sqrt", "", "", Parity::none, 0},
    {Op::sin, 1, "sin", "sin", "\\sin", "sin", Parity::odd, 0, true},
    {Op::cos, 1, "cos", "cos", "\\cos", "cos", Parity::even, 1, true},
    {Op::tan, 1, "tan", "tan", "\\tan", "tan", Parity::odd, 0, true},
    {Op::asin, 1, "asin", "asin", "\\arcsin", "arcsin", Parity::odd, 0},
    {Op::acos, 1, "acos", "acos", "\\arccos", "arccos", Parity::none, -1},
    {Op::atan, 1, "atan", "atan", "\\arctan", "arctan", Parity::odd, 0},
    {Op::sinh, 1, "sinh", "sinh", "\\sinh", "sinh", Parity::odd, 0, true},
    {Op::cosh, 1, "cosh", "cosh", "\\cosh", "cosh", Parity::even, 1, true},
    {Op::tanh, 1, "tanh", "tanh", "\\tanh", "tanh", Parity::odd, 0, true},
    {Op::exp, 1, "exp", "exp", "\\exp", "exp", Parity::none, 1},
    {Op::log, 1, "log", "log", "\\ln", "ln", Parity::none, -1},
    {Op::abs, 1, "abs", nullptr, "", "", Parity::even, 0},
    {Op::sign, 1, "sign", nullptr, "\\operatorname{sgn}", "sgn", Parity::odd, 0},
    {Op::atan2, 2, "atan2", "atan2", "\\operatorname{atan2}", "atan2"},
    {Op::min, 2, "min", nullptr, "\\min", "min"},
    {Op::max, 2, "max", nullptr, "\\max", "max"},
    {Op::select, 4, "if", nullptr, "", ""},
}};

constexpr bool is_function(Op op) { return op >= Op::pow; }

/// The row of a function. Throws std::out_of_range if `op` is not a function.
constexpr const Function& function_of(Op op) {
  return function_table.at(static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::pow));
}

namespace detail {
constexpr bool rows_are_in_order() {
  for (const Function& f : function_table) {
    if (function_of(f.op).op != f.op || &function_of(f.op) != &f) return false;
  }
  return static_cast<std::size_t>(Op::select) == static_cast<std::size_t>(Op::pow) + function_table.size() - 1;
}
}  // namespace detail
static_assert(detail::rows_are_in_order());

/// The derivative of v = f(x), a differentiable function of one argument. `numbers` provides one(), two(), square(a)
/// and call(op, a); Number has + - *.
template <class Number, class Numbers>
eom::expressions::SlopeOf<Number> slope_of(const Function& f, const Number& x, const Number& v,
                                           const Numbers& numbers) {
  return eom::expressions::slope_of(
      f.derivative(), x, v, numbers,
      [&](eom::expressions::Op op, const Number& a) -> Number { return numbers.call(graph_op(op), a); });
}

/// The `numbers` argument of slope_of for expressions.
struct ScalarNumbers {
  Dag& dag;
  Scalar one() const { return {&dag, dag.one()}; }
  Scalar two() const { return {&dag, dag.integer(2)}; }
  Scalar square(Scalar a) const { return {&dag, dag.power(a.ref, 2)}; }
  Scalar call(Op op, Scalar a) const { return {&dag, dag.call(op, a.ref)}; }
};

}  // namespace eomgen::symbolic
