// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/evaluate.hpp"

#include <cln/float.h>
#include <cln/integer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "work.hpp"

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

/// Values of some nodes, ascending: of a few among many there are no places for the others.
template <class Real>
class Values {
 public:
  Values(const std::vector<Ref>& nodes, std::size_t all)
      : nodes_(nodes), few_(nodes.size() < all / 16), values_(few_ ? nodes.size() : all) {}
  Real& operator[](std::uint32_t id) { return values_[place(id)]; }
  const Real& operator[](std::uint32_t id) const { return values_[place(id)]; }

 private:
  std::size_t place(std::uint32_t id) const {
    return few_ ? static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), Ref{id}) - nodes_.begin())
                : id;
  }
  const std::vector<Ref>& nodes_;
  bool few_;
  std::vector<Real> values_;
};

template <class Real, class Arithmetic, class Lookup>
Real value_of(const Dag& dag, Ref r, const Values<Real>& value, const Lookup& lookup, const Arithmetic& number) {
  const Node& node = dag[r];
  const auto arg = [&](std::size_t i) -> const Real& { return value[node.args[i].id]; };
  switch (node.op) {
    case Op::constant: return number.constant(dag.value(r));
    case Op::pi: return number.pi();
    case Op::symbol: return lookup(dag.symbol_of(r));
    case Op::add: return arg(0) + arg(1);
    case Op::sub: return arg(0) - arg(1);
    case Op::mul: return arg(0) * arg(1);
    case Op::div: return number.divide(arg(0), arg(1));
    case Op::neg: return -arg(0);
    case Op::power: return number.power(arg(0), node.payload);
    case Op::pow: return number.pow(arg(0), arg(1));
    case Op::atan2: return number.atan2(arg(0), arg(1));
    case Op::min: return number.less(arg(1), arg(0)) ? arg(1) : arg(0);
    case Op::max: return number.less(arg(0), arg(1)) ? arg(1) : arg(0);
    case Op::select: return number.less(arg(0), arg(1)) ? arg(2) : arg(3);
    default: return number.call(node.op, arg(0));
  }
}

template <class Real, class Arithmetic, class Lookup>
std::vector<Real> run(const Dag& dag, const std::vector<Ref>& roots, const Lookup& lookup, const Arithmetic& number) {
  const std::vector<Ref> nodes = dag.reachable(roots);
  Values<Real> value(nodes, dag.size());
  std::map<std::uint32_t, std::string> missing;  // outside of a domain, and why; the branch that is not taken may be
  // What the value is made of lacks one.
  const auto gap = [&](Ref r) -> const std::string* {
    if (missing.empty()) return nullptr;
    const Node& node = dag[r];
    const auto in = [&](std::size_t i) -> const std::string* {
      const auto found = missing.find(node.args[i].id);
      return found == missing.end() ? nullptr : &found->second;
    };
    const std::size_t operands = node.op == Op::select ? 2 : node.arity;
    for (std::size_t i = 0; i < operands; ++i) {
      if (const std::string* why = in(i)) return why;
    }
    if (node.op != Op::select) return nullptr;
    return in(number.less(value[node.args[0].id], value[node.args[1].id]) ? 2 : 3);
  };
  for (const Ref r : nodes) {
    if (const std::string* why = gap(r)) {
      missing.emplace(r.id, *why);
      continue;
    }
    try {
      value[r.id] = value_of(dag, r, value, lookup, number);
    } catch (const std::domain_error& outside) {
      missing.emplace(r.id, outside.what());
    }
  }
  std::vector<Real> results;
  for (const Ref root : roots) {
    if (const auto found = missing.find(root.id); found != missing.end()) throw std::domain_error(found->second);
    results.push_back(value[root.id]);
  }
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
