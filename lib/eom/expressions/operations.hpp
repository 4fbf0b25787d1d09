// SPDX-License-Identifier: MIT
// The operations of expressions that a run evaluates itself: inputs, event functions, functions that may jump. Their
// values in binary64 and the forms of their derivatives.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace eom::expressions {

/// The operations after the leaves, each with its number of operands. The generator's graph uses the same list
/// (symbolic/dag.hpp). power: a[0] to the integer a[1], 2 or more; pow: a[0] ^ a[1], general; select: a[0] < a[1] ?
/// a[2] : a[3].
// clang-format off
#define EOM_OPERATIONS(OPERATION)                                                             \
  OPERATION(add, 2) OPERATION(sub, 2) OPERATION(mul, 2) OPERATION(div, 2) OPERATION(neg, 1)   \
  OPERATION(power, 1) OPERATION(pow, 2) OPERATION(sqrt, 1)                                    \
  OPERATION(sin, 1) OPERATION(cos, 1) OPERATION(tan, 1)                                       \
  OPERATION(asin, 1) OPERATION(acos, 1) OPERATION(atan, 1)                                    \
  OPERATION(sinh, 1) OPERATION(cosh, 1) OPERATION(tanh, 1)                                    \
  OPERATION(exp, 1) OPERATION(log, 1) OPERATION(abs, 1) OPERATION(sign, 1)                    \
  OPERATION(atan2, 2) OPERATION(min, 2) OPERATION(max, 2) OPERATION(select, 4)
// clang-format on
#define EOM_OPERATION_ENUMERATOR(name, operands) name,
#define EOM_OPERATION_TEXT(name, operands) #name,
#define EOM_OPERATION_OPERANDS(name, operands) operands,

enum class Op : std::uint8_t {
  number,     // a[0]: index into the numbers of the table
  variable,   // a[0]: index into the variables
  parameter,  // a[0]: index into the parameters of the model
  EOM_OPERATIONS(EOM_OPERATION_ENUMERATOR)
};

/// The name of an operation as above.
constexpr const char* name_of(Op op) {
  constexpr std::array names{"number", "variable", "parameter", EOM_OPERATIONS(EOM_OPERATION_TEXT)};
  return names.at(static_cast<std::size_t>(op));
}

constexpr std::size_t operands(Op op) {
  constexpr std::array<std::size_t, 28> counts{0, 0, 0, EOM_OPERATIONS(EOM_OPERATION_OPERANDS)};
  return counts.at(static_cast<std::size_t>(op));
}

/// Whether the value or the slope jumps at a surface given by the operands, with different expressions on its sides.
constexpr bool is_kink(Op op) {
  return op == Op::abs || op == Op::sign || op == Op::min || op == Op::max || op == Op::select;
}
/// Kinks whose surface is one operand, not a comparison of two.
constexpr bool of_one(Op op) { return op == Op::abs || op == Op::sign; }
/// Whether the function itself jumps there, not only its slope.
constexpr bool jumps(Op op) { return op == Op::sign || op == Op::select; }

/// A function of one argument in binary64. NaN or infinite if it has no value.
inline double call(Op op, double x) {
  switch (op) {
    case Op::sqrt: return std::sqrt(x);
    case Op::sin: return std::sin(x);
    case Op::cos: return std::cos(x);
    case Op::tan: return std::tan(x);
    case Op::asin: return std::asin(x);
    case Op::acos: return std::acos(x);
    case Op::atan: return std::atan(x);
    case Op::sinh: return std::sinh(x);
    case Op::cosh: return std::cosh(x);
    case Op::tanh: return std::tanh(x);
    case Op::exp: return std::exp(x);
    case Op::log: return std::log(x);
    case Op::abs: return std::fabs(x);
    case Op::sign: return x > 0 ? 1.0 : x < 0 ? -1.0 : x;
    default: return std::nan("");
  }
}

/// The form of dv/dx of v = f(x), up to its sign.
enum class Slope : std::uint8_t {
  none,             // several arguments, or constant away from a kink
  other,            // g(x), g being `Derivative::other`
  self,             // v
  one_plus_v2,      // 1 + v^2
  one_minus_v2,     // 1 - v^2
  over_x,           // 1/x
  over_2v,          // 1/(2 v)
  over_root,        // 1/sqrt(1 - x^2)
  over_one_plus_x2  // 1/(1 + x^2)
};

/// The derivative of an operation with one argument.
struct Derivative {
  Slope form = Slope::none;
  bool falls = false;  // the derivative is minus `form`
  Op other = Op::pow;  // of Slope::other
};

constexpr Derivative derivative_of(Op op) {
  switch (op) {
    case Op::sqrt: return {Slope::over_2v};
    case Op::sin: return {Slope::other, false, Op::cos};
    case Op::cos: return {Slope::other, true, Op::sin};
    case Op::tan: return {Slope::one_plus_v2};
    case Op::asin: return {Slope::over_root};
    case Op::acos: return {Slope::over_root, true};
    case Op::atan: return {Slope::over_one_plus_x2};
    case Op::sinh: return {Slope::other, false, Op::cosh};
    case Op::cosh: return {Slope::other, false, Op::sinh};
    case Op::tanh: return {Slope::one_minus_v2};
    case Op::exp: return {Slope::self};
    case Op::log: return {Slope::over_x};
    case Op::abs: return {Slope::other, false, Op::sign};
    default: return {};
  }
}

/// dv/dx is `size` or 1/`size`, or minus that.
template <class Number>
struct SlopeOf {
  Number size;
  bool divides, falls;
};

/// The derivative of v = f(x), a differentiable function of one argument. `numbers` has one(), two() and square(a);
/// call(op, a) is a function of one argument. Number has + - *.
template <class Number, class Numbers, class Call>
SlopeOf<Number> slope_of(const Derivative& derivative, const Number& x, const Number& v, const Numbers& numbers,
                         const Call& call) {
  const auto size = [&]() -> Number {
    switch (derivative.form) {
      case Slope::other: return call(derivative.other, x);
      case Slope::self: return v;
      case Slope::one_plus_v2: return numbers.one() + numbers.square(v);
      case Slope::one_minus_v2: return numbers.one() - numbers.square(v);
      case Slope::over_x: return x;
      case Slope::over_2v: return numbers.two() * v;
      case Slope::over_root: return call(Op::sqrt, numbers.one() - numbers.square(x));
      case Slope::over_one_plus_x2: return numbers.one() + numbers.square(x);
      case Slope::none: break;
    }
    return numbers.one() - numbers.one();
  };
  return {size(), derivative.form >= Slope::over_x, derivative.falls};
}

}  // namespace eom::expressions
