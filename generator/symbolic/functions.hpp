// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the graph, one row each: on how many arguments, their symmetry, their value at 0, their derivative,
// and their names in the model language and in the targets. The rules of the graph, derivatives, printing, emission and
// counts read it. The judge has a table of its own, since it is to notice what is wrong here.
#pragma once

#include <array>
#include <cstdint>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

enum class Parity : std::uint8_t { none, even, odd };

/// The form of dv/dx of v = f(x), beside its sign.
enum class Slope : std::uint8_t {
  none,             // several arguments, or constant away from a kink
  other,            // g(x), g being `Function::other`
  self,             // v
  one_plus_v2,      // 1 + v^2
  one_minus_v2,     // 1 - v^2
  over_x,           // 1/x
  over_2v,          // 1/(2 v)
  over_root,        // 1/sqrt(1 - x^2)
  over_one_plus_x2  // 1/(1 + x^2)
};

struct Function {
  Op op;
  std::uint8_t arity;
  const char* name;            // in the model language
  const char* code;            // in C, C++, CUDA, JavaScript and Python; none: written out
  const char *latex, *mathml;  // empty: a notation of its own
  Parity parity = Parity::none;
  int at_zero = -1;  // 0 or 1; otherwise nothing is known of f(0)
  Slope slope = Slope::none;
  bool falls = false;   // dv/dx is minus what `slope` says
  Op other = Op::pow;   // of Slope::other
  bool raised = false;  // its powers are printed at its name: sin^2 x
};

/// In the order of Op, from Op::pow on.
inline constexpr std::array<Function, 19> function_table{{
    {Op::pow, 2, "^", "pow", "", ""},
    {Op::sqrt, 1, "sqrt", "sqrt", "", "", Parity::none, 0, Slope::over_2v},
    {Op::sin, 1, "sin", "sin", "\\sin", "sin", Parity::odd, 0, Slope::other, false, Op::cos, true},
    {Op::cos, 1, "cos", "cos", "\\cos", "cos", Parity::even, 1, Slope::other, true, Op::sin, true},
    {Op::tan, 1, "tan", "tan", "\\tan", "tan", Parity::odd, 0, Slope::one_plus_v2, false, Op::pow, true},
    {Op::asin, 1, "asin", "asin", "\\arcsin", "arcsin", Parity::odd, 0, Slope::over_root},
    {Op::acos, 1, "acos", "acos", "\\arccos", "arccos", Parity::none, -1, Slope::over_root, true},
    {Op::atan, 1, "atan", "atan", "\\arctan", "arctan", Parity::odd, 0, Slope::over_one_plus_x2},
    {Op::sinh, 1, "sinh", "sinh", "\\sinh", "sinh", Parity::odd, 0, Slope::other, false, Op::cosh, true},
    {Op::cosh, 1, "cosh", "cosh", "\\cosh", "cosh", Parity::even, 1, Slope::other, false, Op::sinh, true},
    {Op::tanh, 1, "tanh", "tanh", "\\tanh", "tanh", Parity::odd, 0, Slope::one_minus_v2, false, Op::pow, true},
    {Op::exp, 1, "exp", "exp", "\\exp", "exp", Parity::none, 1, Slope::self},
    {Op::log, 1, "log", "log", "\\ln", "ln", Parity::none, -1, Slope::over_x},
    {Op::abs, 1, "abs", nullptr, "", "", Parity::even, 0, Slope::other, false, Op::sign},
    {Op::sign, 1, "sign", nullptr, "\\operatorname{sgn}", "sgn", Parity::odd, 0},
    {Op::atan2, 2, "atan2", "atan2", "\\operatorname{atan2}", "atan2"},
    {Op::min, 2, "min", nullptr, "\\min", "min"},
    {Op::max, 2, "max", nullptr, "\\max", "max"},
    {Op::select, 4, "if", nullptr, "", ""},
}};

constexpr bool is_function(Op op) { return op >= Op::pow; }

/// Its row; throws std::out_of_range where `op` is no function.
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

/// dv/dx is `size`, or 1/`size`; and minus that.
template <class Number>
struct Sloped1 {
  Number size;
  bool divides, falls;
};

/// The derivative of v = f(x), a function of one argument that has one. `numbers` gives one() and two(), square(a) and
/// call(op, a); Number has + - *.
template <class Number, class Numbers>
Sloped1<Number> slope_of(const Function& f, const Number& x, const Number& v, const Numbers& numbers) {
  const auto size = [&]() -> Number {
    switch (f.slope) {
      case Slope::other: return numbers.call(f.other, x);
      case Slope::self: return v;
      case Slope::one_plus_v2: return numbers.one() + numbers.square(v);
      case Slope::one_minus_v2: return numbers.one() - numbers.square(v);
      case Slope::over_x: return x;
      case Slope::over_2v: return numbers.two() * v;
      case Slope::over_root: return numbers.call(Op::sqrt, numbers.one() - numbers.square(x));
      case Slope::over_one_plus_x2: return numbers.one() + numbers.square(x);
      case Slope::none: break;
    }
    return numbers.one() - numbers.one();
  };
  return {size(), f.slope >= Slope::over_x, f.falls};
}

/// `numbers` of slope_of for expressions.
struct ScalarNumbers {
  Dag& dag;
  Scalar one() const { return {&dag, dag.one()}; }
  Scalar two() const { return {&dag, dag.integer(2)}; }
  Scalar square(Scalar a) const { return {&dag, dag.power(a.ref, 2)}; }
  Scalar call(Op op, Scalar a) const { return {&dag, dag.call(op, a.ref)}; }
};

}  // namespace eomgen::symbolic
