// SPDX-License-Identifier: GPL-3.0-or-later
// The numerical value of every operation of the graph: in binary64, or with CLN at any precision. Expressions,
// programs, derivatives and signals are evaluated with it.
#pragma once

#include <cln/float.h>
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <cmath>
#include <stdexcept>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Message of the std::domain_error of a division by zero.
inline constexpr const char* division_by_zero = "division by zero";
/// Message of the std::domain_error of an exponential above the exponent range of CLN's floats.
inline constexpr const char* exponent_too_large = "the exponential of a number above 1e18";

/// Arithmetic with CLN floats of one format. Exact rationals are rounded once. Throws std::domain_error outside the
/// real domain of a function and for a division by zero.
struct ClnArithmetic {
  using Number = cln::cl_R;
  cln::float_format_t format;

  cln::cl_F round(const cln::cl_R& x) const { return cln::cl_float(x, format); }
  cln::cl_R constant(const Rational& value) const { return round(value); }
  cln::cl_R pi() const { return cln::pi(format); }

  static void require(bool ok, const char* what) {
    if (!ok) throw std::domain_error(what);
  }
  cln::cl_R divide(const cln::cl_R& a, const cln::cl_R& b) const {
    require(!cln::zerop(b), division_by_zero);
    return a / b;
  }
  static cln::cl_R power(const cln::cl_R& a, long n) { return cln::expt(a, cln::cl_I(n)); }
  cln::cl_R pow(const cln::cl_R& a, const cln::cl_R& b) const {
    require(cln::plusp(a), "real power of a number that is not positive");
    return exp(round(b * cln::ln(round(a))));
  }
  cln::cl_R call(Op op, const cln::cl_R& argument) const {
    const cln::cl_F x = round(argument);
    switch (op) {
      case Op::sqrt: require(!cln::minusp(x), "sqrt of a negative number"); return cln::sqrt(x);
      case Op::sin: return cln::sin(reducible(x));
      case Op::cos: return cln::cos(reducible(x));
      case Op::tan: return cln::tan(reducible(x));
      case Op::asin: return arcsine(x);
      case Op::acos: return cln::pi(format) / 2 - arcsine(x);
      case Op::atan: return cln::atan(x);
      case Op::sinh: return cln::sinh(exponent(x));
      case Op::cosh: return cln::cosh(exponent(x));
      case Op::tanh: return cln::tanh(x);
      case Op::exp: return exp(x);
      case Op::log: require(cln::plusp(x), "log of a number that is not positive"); return cln::ln(x);
      case Op::abs: return cln::abs(x);
      case Op::sign: return cln::zerop(x) ? cln::cl_R(0) : cln::minusp(x) ? cln::cl_R(-1) : cln::cl_R(1);
      default: throw std::logic_error("not a function of one argument");
    }
  }
  /// The argument of a trigonometric function. CLN subtracts a multiple of pi that has the digits of the whole part:
  /// the largest floats would take all memory.
  static const cln::cl_F& reducible(const cln::cl_F& x) {
    constexpr long most_bits = 1 << 16;
    require(cln::float_exponent(x) <= most_bits, "an angle of more than 65536 bits before its point");
    return x;
  }
  /// 0 if the result is below the exponent range of CLN's floats.
  static cln::cl_R exp(const cln::cl_F& x) {
    if (x < -largest_exponent()) return 0;
    return cln::exp(exponent(x));
  }
  /// The argument of an exponential, within the exponent range of CLN's floats.
  static const cln::cl_F& exponent(const cln::cl_F& x) {
    require(cln::abs(x) <= largest_exponent(), exponent_too_large);
    return x;
  }
  static const cln::cl_I& largest_exponent() {
    static const cln::cl_I value = cln::expt_pos(cln::cl_I(10), 18);
    return value;
  }
  cln::cl_R arcsine(const cln::cl_F& x) const {
    require(cln::abs(x) <= cln::cl_R(1), "asin or acos outside [-1, 1]");
    const cln::cl_F cosine = cln::sqrt(cln::cl_float((1 - x) * (1 + x), format));
    return cln::atan(cosine, x);  // CLN: the angle of cosine + i x
  }
  static cln::cl_R atan2(const cln::cl_R& y, const cln::cl_R& x) {
    require(!(cln::zerop(x) && cln::zerop(y)), "atan2(0, 0)");
    return cln::atan(x, y);
  }
  static bool less(const cln::cl_R& a, const cln::cl_R& b) { return a < b; }
};

/// Arithmetic in binary64. The result is NaN or infinite if there is no value.
struct Binary64Arithmetic {
  using Number = double;
  static double round(double x) { return x; }
  static double constant(const Rational& value) { return cln::double_approx(value); }
  static double pi() { return 3.14159265358979323846; }
  static double divide(double a, double b) { return a / b; }
  static double power(double a, long n) { return std::pow(a, static_cast<double>(n)); }
  static double pow(double a, double b) { return std::pow(a, b); }
  static double call(Op op, double x) { return eom::expressions::call(runtime_op(op), x); }
  static double atan2(double y, double x) { return std::atan2(y, x); }
  static bool less(double a, double b) { return a < b; }
};

/// The value of an operation (not a leaf) for the operands arg(0), arg(1), ... of type Arithmetic::Number. `exponent`
/// belongs to Op::power.
template <class Arithmetic, class Argument>
typename Arithmetic::Number value_of(Op op, long exponent, const Argument& arg, const Arithmetic& number) {
  switch (op) {
    case Op::add: return arg(0) + arg(1);
    case Op::sub: return arg(0) - arg(1);
    case Op::mul: return arg(0) * arg(1);
    case Op::div: return number.divide(arg(0), arg(1));
    case Op::neg: return -arg(0);
    case Op::power: return number.power(arg(0), exponent);
    case Op::pow: return number.pow(arg(0), arg(1));
    case Op::atan2: return number.atan2(arg(0), arg(1));
    case Op::min: return number.less(arg(1), arg(0)) ? arg(1) : arg(0);
    case Op::max: return number.less(arg(0), arg(1)) ? arg(1) : arg(0);
    case Op::select: return number.less(arg(0), arg(1)) ? arg(2) : arg(3);
    default: return number.call(op, arg(0));
  }
}

}  // namespace eomgen::symbolic
