// SPDX-License-Identifier: GPL-3.0-or-later
// Powers and function calls in canonical form.
#include <cln/integer.h>
#include <cln/rational.h>

#include <optional>

#include "reading/sum.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::reading {
namespace {

constexpr long largest_expanded_exponent = 64;

AtomPtr sum_atom(const Sum& base) {
  Atom atom;
  atom.op = Op::add;
  atom.args = {base};
  // A sum of positive terms is positive. Even powers are not negative, but may vanish.
  atom.positive = !base.is_zero();
  for (const auto& [monomial, coefficient] : base.terms()) {
    atom.positive = atom.positive && cln::plusp(coefficient);
    for (const Factor& factor : monomial) atom.positive = atom.positive && factor.atom->positive;
  }
  return std::make_shared<const Atom>(std::move(atom));
}

// A sum under a power is expanded only for positive integer exponents.
Sum atomic_power(const Sum& base, const Rational& exponent) {
  if (base.is_number() && is_one(base.number())) return 1;
  return Sum(Monomial{{sum_atom(base), exponent}}, 1);
}

// The exact part of a root of a positive number is extracted: 4 -> 2; sqrt(8) stays.
Sum number_power(const Rational& number, const Rational& exponent) {
  if (is_integer(exponent)) {
    const long n = to_long(exponent);
    if (n >= 0) return Sum(cln::expt(number, static_cast<int>(n)));
    return Sum(cln::recip(cln::expt(number, static_cast<int>(-n))));
  }
  Rational root;
  if (cln::denominator(exponent) == 2 && !cln::minusp(number) && cln::sqrtp(number, &root)) {
    return number_power(root, exponent * 2);
  }
  return atomic_power(Sum(number), exponent);
}

/// A sum without negative terms: x^2 + y^2 for any x and y.
bool never_negative(const Sum& sum) {
  for (const auto& [monomial, coefficient] : sum.terms()) {
    if (cln::minusp(coefficient)) return false;
    for (const Factor& factor : monomial) {
      const bool even = is_integer(factor.exponent) && cln::evenp(cln::numerator(factor.exponent));
      if (!even && !factor.atom->positive && factor.atom->op != Op::abs && factor.atom->op != Op::sqrt) return false;
    }
  }
  return true;
}

Sum absolute(const AtomPtr& atom) {
  if (atom->op == Op::add) return call(Op::abs, {atom->args[0]});  // a sum is an atom only under powers other than 1
  if (atom->positive) return Sum(atom);
  if (atom->op == Op::abs || atom->op == Op::sqrt) return Sum(atom);
  return call(Op::abs, {Sum(atom)});
}

// (c x^a y^b)^e for one term.
Sum term_power(const Monomial& monomial, const Rational& coefficient, const Rational& exponent) {
  if (is_integer(exponent)) {
    Sum result = number_power(coefficient, exponent);
    Monomial powers = monomial;
    for (Factor& factor : powers) factor.exponent = factor.exponent * exponent;
    return result * multiply(powers, {});
  }
  Sum outside(1);
  Monomial inside;
  for (const Factor& factor : monomial) {
    const bool even = is_integer(factor.exponent) && cln::evenp(cln::numerator(factor.exponent));
    if (factor.atom->positive) {
      outside = outside * multiply({{factor.atom, factor.exponent * exponent}}, {});
    } else if (even) {
      outside = outside * power(absolute(factor.atom), factor.exponent * exponent);
    } else {
      inside.push_back(factor);
    }
  }
  if (inside.empty()) return outside * number_power(coefficient, exponent);
  const Rational size = cln::abs(coefficient);
  return outside * number_power(size, exponent) *
         atomic_power(Sum(inside, cln::minusp(coefficient) ? -1 : 1), exponent);
}

}  // namespace

Sum power(const Sum& x, const Rational& exponent) {
  if (cln::zerop(exponent)) return 1;
  if (is_one(exponent)) return x;
  if (x.is_zero()) {
    if (cln::minusp(exponent)) throw std::domain_error("division by zero");
    return 0;
  }
  if (x.size() == 1) return term_power(x.terms().begin()->first, x.terms().begin()->second, exponent);
  if (is_integer(exponent) && cln::plusp(exponent)) {
    if (exponent > largest_expanded_exponent) throw TermBudget();
    Sum result = x;
    for (long n = to_long(exponent); n > 1; --n) result = result * x;
    return result;
  }
  Content common = content(x);
  if (!is_integer(exponent)) {
    // Only powers of positive atoms leave a root.
    std::erase_if(common.monomial, [](const Factor& f) {
      return !f.atom->positive && !(is_integer(f.exponent) && cln::evenp(cln::numerator(f.exponent)));
    });
  }
  Sum primitive = divide(x, common);
  Sum factor = term_power(common.monomial, common.number, exponent);
  if (is_integer(exponent) && has_negative_leading_term(primitive)) {
    primitive = -primitive;
    if (cln::oddp(cln::numerator(exponent))) factor = -factor;
  }
  return factor * atomic_power(primitive, exponent);
}

namespace {

/// Integer quarter turns in an angle with other terms: 1 of pi/2 - x; they are removed from the angle. None if the
/// number is no integer.
long take_quarter_turns(Sum& angle) {
  for (const auto& [monomial, coefficient] : angle.terms()) {
    const bool of_pi = monomial.size() == 1 && monomial[0].atom->op == Op::pi && is_one(monomial[0].exponent);
    if (!of_pi) continue;
    const Rational quarters = 2 * coefficient;
    if (!is_integer(quarters)) return 0;
    const long turns = cln::cl_I_to_long(cln::mod(cln::numerator(quarters), 4));
    angle -= Sum(monomial, coefficient);
    return turns;
  }
  return 0;
}

/// sin(pi/2 - x) = cos(x), cos(x + pi) = -cos(x).
std::optional<Sum> without_quarter_turns(Op function, const Sum& angle) {
  if (function != Op::sin && function != Op::cos) return std::nullopt;
  Sum rest = angle;
  const long turns = take_quarter_turns(rest);
  if (rest.size() == angle.size()) return std::nullopt;
  const bool exchanged = turns % 2 == 1;
  const Op other = function == Op::sin ? Op::cos : Op::sin;
  const Sum value = call(exchanged ? other : function, {std::move(rest)});
  // sin: x, cos, -sin, -cos; cos: x, -sin, -cos, sin.
  const bool minus = function == Op::sin ? turns >= 2 : turns == 1 || turns == 2;
  return minus ? -value : value;
}

}  // namespace

Sum call(Op function, std::vector<Sum> args) {
  if (args.size() == 1) {
    if (std::optional<Sum> value = without_quarter_turns(function, args[0])) return *std::move(value);
  }
  const auto negated = [&]() -> Sum { return call(function, {-args[0]}); };
  if (args.size() == 1 && has_negative_leading_term(args[0])) {
    switch (symbolic::function_of(function).parity) {
      case symbolic::Parity::odd: return -negated();
      case symbolic::Parity::even: return negated();
      case symbolic::Parity::none: break;
    }
  }
  if (function == Op::abs && args[0].size() > 1 && never_negative(args[0])) return args[0];
  Atom atom;
  atom.op = function;
  if (function == Op::exp || function == Op::cosh) atom.positive = true;
  if (args.size() == 1 && args[0].size() == 1) {
    const auto& [monomial, coefficient] = *args[0].terms().begin();
    const bool single = monomial.size() == 1 && is_one(coefficient) && is_one(monomial[0].exponent);
    if (function == Op::sin && single && monomial[0].atom->is_half_turn_angle) atom.positive = true;
    if (function == Op::abs) {
      if (monomial.empty()) return Sum(cln::abs(coefficient));
      bool positive = true;
      for (const Factor& factor : monomial) positive = positive && factor.atom->positive;
      if (positive) return Sum(monomial, cln::abs(coefficient));
    }
  }
  if (args.size() == 1 && args[0].is_zero()) {
    if (function == Op::cos || function == Op::cosh || function == Op::exp) return 1;
    if (function != Op::acos && function != Op::log) return 0;
  }
  if (function == Op::abs && args[0].size() > 1) atom.positive = false;
  atom.args = std::move(args);
  return Sum(std::make_shared<const Atom>(std::move(atom)));
}

}  // namespace eomgen::reading
