// SPDX-License-Identifier: GPL-3.0-or-later
// Values of display forms in binary64, by direct evaluation of the sum.
#pragma once

#include <cln/rational.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "reading/sum.hpp"

namespace eomgen::test {

using Values = std::map<reading::Symbol, double>;

double value_of(const reading::Sum& sum, const Values& at);

inline double value_of(const reading::Atom& atom, const Values& at) {
  using reading::Op;
  const auto arg = [&](std::size_t k) { return value_of(atom.args[k], at); };
  switch (atom.op) {
    case Op::symbol: return at.at(atom.symbol);
    case Op::add: return arg(0);
    case Op::pow: return std::pow(arg(0), arg(1));
    case Op::sin: return std::sin(arg(0));
    case Op::cos: return std::cos(arg(0));
    case Op::tan: return std::tan(arg(0));
    case Op::exp: return std::exp(arg(0));
    case Op::log: return std::log(arg(0));
    case Op::sinh: return std::sinh(arg(0));
    case Op::cosh: return std::cosh(arg(0));
    case Op::sqrt: return std::sqrt(arg(0));
    case Op::abs: return std::abs(arg(0));
    default: throw std::logic_error("no value for this function");
  }
}

inline double value_of(const reading::Sum& sum, const Values& at) {
  double result = 0;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    double term = cln::double_approx(coefficient);
    for (const reading::Factor& factor : monomial) {
      term *= std::pow(value_of(*factor.atom, at), cln::double_approx(factor.exponent));
    }
    result += term;
  }
  return result;
}

}  // namespace eomgen::test
