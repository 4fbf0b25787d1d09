// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/ginac_bridge.hpp"

namespace eomgen::reading {
namespace {

using GiNaC::ex;
using GiNaC::function;
using GiNaC::function_options;

ex call(unsigned serial, const std::vector<ex>& args) { return GiNaC::function(serial, GiNaC::exvector(args)); }

// Registered on first use, so that there is no order of static initialisation to mind.
unsigned sign_serial();
unsigned select_serial();

ex select(const ex& a, const ex& b, const ex& x, const ex& y) { return call(select_serial(), {a, b, x, y}); }
ex abs_derivative(const ex& x, unsigned) { return call(sign_serial(), {x}); }
ex sign_derivative(const ex&, unsigned) { return 0; }
ex min_derivative(const ex& a, const ex& b, unsigned k) { return k == 0 ? select(b, a, 0, 1) : select(b, a, 1, 0); }
ex max_derivative(const ex& a, const ex& b, unsigned k) { return k == 0 ? select(a, b, 0, 1) : select(a, b, 1, 0); }
ex select_derivative(const ex& a, const ex& b, const ex&, const ex&, unsigned k) {
  if (k == 2) return select(a, b, 1, 0);
  if (k == 3) return select(a, b, 0, 1);
  return 0;
}

unsigned abs_serial() {
  static const unsigned serial =
      function::register_new(function_options("real_abs", 1).derivative_func(abs_derivative));
  return serial;
}
unsigned sign_serial() {
  static const unsigned serial =
      function::register_new(function_options("real_sign", 1).derivative_func(sign_derivative));
  return serial;
}
unsigned min_serial() {
  static const unsigned serial =
      function::register_new(function_options("real_min", 2).derivative_func(min_derivative));
  return serial;
}
unsigned max_serial() {
  static const unsigned serial =
      function::register_new(function_options("real_max", 2).derivative_func(max_derivative));
  return serial;
}
unsigned select_serial() {
  static const unsigned serial =
      function::register_new(function_options("real_select", 4).derivative_func(select_derivative));
  return serial;
}

}  // namespace

ex ginac_call(Op op, const std::vector<ex>& args) {
  const ex& x = args[0];
  switch (op) {
    case Op::sqrt: return GiNaC::sqrt(x);
    case Op::sin: return GiNaC::sin(x);
    case Op::cos: return GiNaC::cos(x);
    case Op::tan: return GiNaC::tan(x);
    case Op::asin: return GiNaC::asin(x);
    case Op::acos: return GiNaC::acos(x);
    case Op::atan: return GiNaC::atan(x);
    case Op::sinh: return GiNaC::sinh(x);
    case Op::cosh: return GiNaC::cosh(x);
    case Op::tanh: return GiNaC::tanh(x);
    case Op::exp: return GiNaC::exp(x);
    case Op::log: return GiNaC::log(x);
    case Op::atan2: return GiNaC::atan2(x, args[1]);
    case Op::pow: return GiNaC::pow(x, args[1]);
    case Op::abs: return call(abs_serial(), args);
    case Op::sign: return call(sign_serial(), args);
    case Op::min: return call(min_serial(), args);
    case Op::max: return call(max_serial(), args);
    case Op::select: return call(select_serial(), args);
    default: throw std::logic_error("not a function");
  }
}

Op function_of(const function& f) {
  const unsigned serial = f.get_serial();
  if (serial == abs_serial()) return Op::abs;
  if (serial == sign_serial()) return Op::sign;
  if (serial == min_serial()) return Op::min;
  if (serial == max_serial()) return Op::max;
  if (serial == select_serial()) return Op::select;
  if (serial == GiNaC::sin_SERIAL::serial) return Op::sin;
  if (serial == GiNaC::cos_SERIAL::serial) return Op::cos;
  if (serial == GiNaC::tan_SERIAL::serial) return Op::tan;
  if (serial == GiNaC::asin_SERIAL::serial) return Op::asin;
  if (serial == GiNaC::acos_SERIAL::serial) return Op::acos;
  if (serial == GiNaC::atan_SERIAL::serial) return Op::atan;
  if (serial == GiNaC::atan2_SERIAL::serial) return Op::atan2;
  if (serial == GiNaC::sinh_SERIAL::serial) return Op::sinh;
  if (serial == GiNaC::cosh_SERIAL::serial) return Op::cosh;
  if (serial == GiNaC::tanh_SERIAL::serial) return Op::tanh;
  if (serial == GiNaC::exp_SERIAL::serial) return Op::exp;
  if (serial == GiNaC::log_SERIAL::serial) return Op::log;
  return Op::symbol;
}

}  // namespace eomgen::reading
