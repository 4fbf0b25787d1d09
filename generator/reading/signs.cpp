// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/signs.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <optional>

namespace eomgen::reading {
namespace {

/// x of |x| and sign(x) if it is one factor without a coefficient; otherwise none.
AtomPtr base_of(const Factor& factor) {
  const Atom& atom = *factor.atom;
  if ((atom.op != Op::abs && atom.op != Op::sign) || !is_integer(factor.exponent)) return nullptr;
  if (atom.args[0].size() != 1) return nullptr;
  const auto& [monomial, coefficient] = *atom.args[0].terms().begin();
  if (coefficient != 1 || monomial.size() != 1 || monomial[0].exponent != 1) return nullptr;
  return monomial[0].atom;
}

bool is_same(const Atom& a, const Atom& b) { return compare(a, b) == 0; }

/// The term with the factors x, |x| and sign(x) in their normal form.
Sum reduced(const Monomial& monomial, const Rational& coefficient, const AtomPtr& x) {
  long size = 0, odd = 0;  // x^a |x|^b sign(x)^c has the size |x|^(a + b), and the sign of x if a + c is odd
  Monomial rest;
  for (const Factor& factor : monomial) {
    const AtomPtr base = base_of(factor);
    if (base != nullptr && is_same(*base, *x)) {
      (factor.atom->op == Op::abs ? size : odd) += to_long(factor.exponent);
    } else if (is_same(*factor.atom, *x)) {
      size += to_long(factor.exponent);
      odd += to_long(factor.exponent);
    } else {
      rest.push_back(factor);
    }
  }
  Sum result(std::move(rest), coefficient);
  const bool has_sign = odd % 2 != 0, is_plain = (size % 2 != 0) == has_sign;
  if (size != 0) {
    const bool power_of_x = is_plain || has_sign;
    const AtomPtr atom = power_of_x ? x : call(Op::abs, {Sum(x)}).terms().begin()->first.front().atom;
    result = result * Sum(Monomial{{atom, size}}, 1);
  }
  if (has_sign && !is_plain) result = result * call(Op::sign, {Sum(x)});
  return result;
}

/// The term with the first x in its normal form of those that are not; none if all are.
std::optional<Sum> reduced(const Monomial& monomial, const Rational& coefficient) {
  for (const Factor& factor : monomial) {
    const AtomPtr x = base_of(factor);
    if (x == nullptr) continue;
    const auto is_fractional = [&](const Factor& other) {
      return is_same(*other.atom, *x) && !is_integer(other.exponent);
    };
    if (std::any_of(monomial.begin(), monomial.end(), is_fractional)) continue;
    Sum result = reduced(monomial, coefficient, x);
    if (!(result == Sum(monomial, coefficient))) return result;
  }
  return std::nullopt;
}

}  // namespace

Sum reduce_signs(const Sum& sum) {
  const auto has_base = [](const auto& term) {
    return std::any_of(term.first.begin(), term.first.end(), [](const Factor& f) { return base_of(f) != nullptr; });
  };
  if (std::none_of(sum.terms().begin(), sum.terms().end(), has_base)) return sum;
  Sum result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    if (const std::optional<Sum> shorter = reduced(monomial, coefficient))
      result += reduce_signs(*shorter);
    else
      result.add(monomial, coefficient);
  }
  return result;
}

}  // namespace eomgen::reading
