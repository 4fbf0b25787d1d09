// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/evaluate.hpp"

#include "work.hpp"

#include <cln/float.h>
#include <cln/integer.h>

#include <cmath>
#include <stdexcept>

namespace eomgen::symbolic {
namespace {

using cln::cl_F;
using cln::cl_R;

/// CLN floats of one format; exact rationals enter as such and are rounded once.
struct Precise {
  cln::float_format_t format;

  cl_F round(const cl_R& x) const { return cln::cl_float(x, format); }
  cl_R constant(const Rational& value) const { return round(value); }
  cl_R pi() const { return cln::pi(format); }

  static void require(bool ok, const char* what) {
    if (!ok) throw std::domain_error(what);
  }
  cl_R divide(const cl_R& a, const cl_R& b) const {
    require(!cln::zerop(b), "division by zero");
    return a / b;
  }
  static cl_R power(const cl_R& a, long n) { return cln::expt(a, cln::cl_I(n)); }
  cl_R pow(const cl_R& a, const cl_R& b) const {
    require(cln::plusp(a), "real power of a number that is not positive");
    return cln::exp(b * cln::ln(round(a)));
  }
  cl_R call(Op op, const cl_R& argument) const {
    const cl_F x = round(argument);
    switch (op) {
      case Op::sqrt: require(!cln::minusp(x), "sqrt of a negative number"); return cln::sqrt(x);
      case Op::sin: return cln::sin(x);
      case Op::cos: return cln::cos(x);
      case Op::tan: return cln::tan(x);
      case Op::asin: return arcsine(x);
      case Op::acos: return cln::pi(format) / 2 - arcsine(x);
      case Op::atan: return cln::atan(x);
      case Op::sinh: return cln::sinh(x);
      case Op::cosh: return cln::cosh(x);
      case Op::tanh: return cln::tanh(x);
      case Op::exp: return cln::exp(x);
      case Op::log: require(cln::plusp(x), "log of a number that is not positive"); return cln::ln(x);
      case Op::abs: return cln::abs(x);
      case Op::sign: return cln::zerop(x) ? cl_R(0) : cln::minusp(x) ? cl_R(-1) : cl_R(1);
      default: throw std::logic_error("not a function of one argument");
    }
  }
  cl_R arcsine(const cl_F& x) const {
    require(cln::abs(x) <= cl_R(1), "asin or acos outside [-1, 1]");
    const cl_F cosine = cln::sqrt(cln::cl_float((1 - x) * (1 + x), format));
    return cln::atan(cosine, x);  // CLN: the angle of cosine + i x
  }
  static cl_R atan2(const cl_R& y, const cl_R& x) {
    require(!(cln::zerop(x) && cln::zerop(y)), "atan2(0, 0)");
    return cln::atan(x, y);
  }
  static bool less(const cl_R& a, const cl_R& b) { return a < b; }
};

struct Binary64 {
  static double constant(const Rational& value) { return cln::double_approx(value); }
  static double pi() { return 3.14159265358979323846; }
  static double divide(double a, double b) { return a / b; }
  static double power(double a, long n) { return std::pow(a, static_cast<double>(n)); }
  static double pow(double a, double b) { return std::pow(a, b); }
  static double call(Op op, double x) {
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
  static double atan2(double y, double x) { return std::atan2(y, x); }
  static bool less(double a, double b) { return a < b; }
};

template <class Real, class Arithmetic, class Lookup>
std::vector<Real> run(const Dag& dag, const std::vector<Ref>& roots, const Lookup& lookup, const Arithmetic& number) {
  std::vector<Real> value(dag.size());
  for (const Ref r : dag.reachable(roots)) {
    const Node& node = dag[r];
    const auto arg = [&](std::size_t i) -> const Real& { return value[node.args[i].id]; };
    Real result;
    switch (node.op) {
      case Op::constant: result = number.constant(dag.value(r)); break;
      case Op::pi: result = number.pi(); break;
      case Op::symbol: result = lookup(dag.symbol_of(r)); break;
      case Op::add: result = arg(0) + arg(1); break;
      case Op::sub: result = arg(0) - arg(1); break;
      case Op::mul: result = arg(0) * arg(1); break;
      case Op::div: result = number.divide(arg(0), arg(1)); break;
      case Op::neg: result = -arg(0); break;
      case Op::power: result = number.power(arg(0), node.payload); break;
      case Op::pow: result = number.pow(arg(0), arg(1)); break;
      case Op::atan2: result = number.atan2(arg(0), arg(1)); break;
      case Op::min: result = number.less(arg(1), arg(0)) ? arg(1) : arg(0); break;
      case Op::max: result = number.less(arg(0), arg(1)) ? arg(1) : arg(0); break;
      case Op::select: result = number.less(arg(0), arg(1)) ? arg(2) : arg(3); break;
      default: result = number.call(node.op, arg(0)); break;
    }
    value[r.id] = result;
  }
  std::vector<Real> results;
  for (const Ref root : roots) results.push_back(value[root.id]);
  return results;
}

}  // namespace

std::vector<cl_R> evaluate(const Dag& dag, const std::vector<Ref>& roots,
                           const std::function<cl_R(const Symbol&)>& lookup, int digits) {
  work::check();
  const Precise arithmetic{cln::float_format(static_cast<std::uintptr_t>(digits))};
  const auto rounded = [&](const Symbol& symbol) -> cl_R { return arithmetic.round(lookup(symbol)); };
  return run<cl_R>(dag, roots, rounded, arithmetic);
}

std::vector<double> evaluate(const Dag& dag, const std::vector<Ref>& roots,
                             const std::function<double(const Symbol&)>& lookup) {
  return run<double>(dag, roots, lookup, Binary64{});
}

}  // namespace eomgen::symbolic
