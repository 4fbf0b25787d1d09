// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of symbolic/functions.hpp in GiNaC, which differentiates its own by its own rules.
#include "reading/ginac_bridge.hpp"

namespace eomgen::reading {
namespace {

using GiNaC::ex;
using GiNaC::function;
using GiNaC::function_options;

ex ginac_function_of(unsigned serial, const std::vector<ex>& args) {
  return GiNaC::function(serial, GiNaC::exvector(args));
}

// Registered on first use, so that the order of static initialisation does not matter.
unsigned sign_serial();
unsigned select_serial();

ex select(const ex& a, const ex& b, const ex& x, const ex& y) {
  return ginac_function_of(select_serial(), {a, b, x, y});
}
ex abs_derivative(const ex& x, unsigned) { return ginac_function_of(sign_serial(), {x}); }
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

/// The table in both directions. pow and sqrt are powers in GiNaC, not functions.
struct Known {
  Op op;
  unsigned serial;
};

const std::vector<Known>& known() {
  static const std::vector<Known> functions{{Op::sin, GiNaC::sin_SERIAL::serial},
                                            {Op::cos, GiNaC::cos_SERIAL::serial},
                                            {Op::tan, GiNaC::tan_SERIAL::serial},
                                            {Op::asin, GiNaC::asin_SERIAL::serial},
                                            {Op::acos, GiNaC::acos_SERIAL::serial},
                                            {Op::atan, GiNaC::atan_SERIAL::serial},
                                            {Op::sinh, GiNaC::sinh_SERIAL::serial},
                                            {Op::cosh, GiNaC::cosh_SERIAL::serial},
                                            {Op::tanh, GiNaC::tanh_SERIAL::serial},
                                            {Op::exp, GiNaC::exp_SERIAL::serial},
                                            {Op::log, GiNaC::log_SERIAL::serial},
                                            {Op::atan2, GiNaC::atan2_SERIAL::serial},
                                            {Op::abs, abs_serial()},
                                            {Op::sign, sign_serial()},
                                            {Op::min, min_serial()},
                                            {Op::max, max_serial()},
                                            {Op::select, select_serial()}};
  return functions;
}

}  // namespace

ex ginac_call(Op op, const std::vector<ex>& args) {
  if (op == Op::sqrt) return GiNaC::sqrt(args[0]);
  if (op == Op::pow) return GiNaC::pow(args[0], args[1]);
  for (const Known& f : known()) {
    if (f.op == op) return ginac_function_of(f.serial, args);
  }
  throw std::logic_error("not a function");
}

Op function_of(const function& f) {
  for (const Known& k : known()) {
    if (k.serial == f.get_serial()) return k.op;
  }
  return Op::symbol;
}

}  // namespace eomgen::reading
