// SPDX-License-Identifier: GPL-3.0-or-later
// Terms over common denominators as one fraction, where their numerator has factors: (p - q cos(x))^2/(I sin(x)^2).
#include <algorithm>
#include <optional>
#include <tuple>

#include "reading/layout.hpp"
#include "reading/rational_function.hpp"

namespace eomgen::reading {
namespace {

/// The factors with negative exponents.
Monomial denominator(const Monomial& monomial) {
  Monomial result;
  for (const Factor& factor : monomial) {
    if (cln::minusp(factor.exponent)) result.push_back({factor.atom, -factor.exponent});
  }
  return result;
}

/// Whether every factor of `a` is in `b`, with an exponent at least as large.
bool divides(const Monomial& a, const Monomial& b) {
  return std::all_of(a.begin(), a.end(), [&](const Factor& f) {
    return std::any_of(b.begin(), b.end(),
                       [&](const Factor& g) { return compare(*f.atom, *g.atom) == 0 && f.exponent <= g.exponent; });
  });
}

/// The sum with sin^2 written as 1 - cos^2.
Sum in_cosines(const Sum& sum) {
  Sum result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Sum term(coefficient);
    for (const Factor& factor : monomial) {
      const bool square = factor.atom->op == Op::sin && is_integer(factor.exponent) && factor.exponent >= 2;
      if (!square) {
        term = term * Sum(Monomial{factor}, 1);
        continue;
      }
      const Sum c = call(Op::cos, factor.atom->args);
      const long pairs = to_long(factor.exponent) / 2;
      term = term * power(Sum(1) - c * c, Rational(pairs));
      if (to_long(factor.exponent) % 2 == 1) term = term * Sum(factor.atom);
    }
    result += term;
  }
  return result;
}

/// Whether of two terms the one that is subtracted has fewer factors: b cos(x) - a, which reads a - b cos(x).
bool reads_negated(const Sum& base) {
  if (base.size() != 2) return false;
  const auto& first = *base.terms().begin();
  const auto& second = *std::next(base.terms().begin());
  if (cln::minusp(first.second) == cln::minusp(second.second)) return false;
  const auto& [minus, plus] = cln::minusp(first.second) ? std::tie(first, second) : std::tie(second, first);
  return degree(minus.first) < degree(plus.first);
}

/// The fraction with the numerator as a product of at least so many factors.
std::optional<Formula> as_one_fraction(const Sum& numerator, const Monomial& below, long least_factors) {
  const Factorisation parts = factorise(numerator);
  long count = 0;
  for (const auto& [base, times] : parts.factors) count += times;
  if (count < least_factors) return std::nullopt;
  int sign = parts.sign;
  std::vector<Formula> brackets;
  for (const auto& [base, times] : parts.factors) {
    const bool negated = reads_negated(base);
    if (negated && times % 2 != 0) sign = -sign;
    Formula f = bracket(negated ? -base : base);
    brackets.push_back(times == 1 ? std::move(f) : make_formula(FormulaKind::power, {std::move(f), number(times)}));
  }
  const Sum front = multiply(parts.content.monomial, inverse(below));
  if (front.size() != 1) return std::nullopt;
  return term_formula(sign * parts.content.number, front.terms().begin()->first, std::move(brackets));
}

}  // namespace

std::vector<Formula> arranged_fractions(const Sum& whole, Layout layout) {
  Monomial largest;
  for (const auto& [monomial, coefficient] : whole.terms()) {
    Monomial below = denominator(monomial);
    if (below.size() > largest.size() || (below.size() == largest.size() && divides(largest, below)))
      largest = std::move(below);
  }
  if (largest.empty()) return arranged_terms(whole, layout);
  // Terms over the largest denominator, then those over a part of it as well, then the former without factors.
  constexpr std::size_t shortest = 2, longest = 8, longest_without_factors = 4;  // terms
  for (const auto& [parts_too, least_factors] : {std::pair{false, 2}, std::pair{true, 2}, std::pair{false, 1}}) {
    Sum joined, rest;
    for (const auto& [monomial, coefficient] : whole.terms()) {
      const Monomial below = denominator(monomial);
      const bool joins = divides(below, largest) && (divides(largest, below) || (parts_too && !below.empty()));
      (joins ? joined : rest).add(monomial, coefficient);
    }
    if (joined.size() < shortest || joined.size() > (least_factors > 1 ? longest : longest_without_factors)) continue;
    const Sum numerator = joined * Sum(largest, 1);
    for (const Sum& form : {numerator, in_cosines(numerator)}) {
      std::optional<Formula> fraction = as_one_fraction(form, largest, least_factors);
      if (!fraction) continue;
      std::vector<Formula> terms = arranged_terms(rest, layout);
      terms.push_back(*std::move(fraction));
      return terms;
    }
  }
  return arranged_terms(whole, layout);
}

Formula arrange_fractions(const Sum& whole, Layout layout) {
  return led_by_plus(sum(arranged_fractions(whole, layout)), layout == Layout::grouped);
}

}  // namespace eomgen::reading
