// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/sum.hpp"

#include <cln/integer.h>

#include "symbolic/monomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::reading {
namespace {

// x |x| is kept, |x|^2 = x^2.
bool is_whole_power_to_expand(const Factor& factor) {
  if (factor.atom->op == Op::add) return is_integer(factor.exponent) && cln::plusp(factor.exponent);
  if (factor.atom->op != Op::abs || !is_integer(factor.exponent)) return false;
  return cln::evenp(cln::numerator(factor.exponent));
}

}  // namespace

bool is_one(const Rational& r) { return r == 1; }
bool is_integer(const Rational& r) { return cln::denominator(r) == 1; }
long to_long(const Rational& r) { return cln::cl_I_to_long(cln::numerator(r)); }

template <class Key>
void Sum::add_term(Key&& monomial, const Rational& coefficient) {
  if (cln::zerop(coefficient)) return;
  work::consume_budget(1);
  symbolic::add_like_term(terms_, std::forward<Key>(monomial), coefficient, symbolic::plus,
                          [](const Rational& value) { return symbolic::is_zero(value); });
}
void Sum::add(const Monomial& monomial, const Rational& coefficient) { add_term(monomial, coefficient); }
void Sum::add(Monomial&& monomial, const Rational& coefficient) { add_term(std::move(monomial), coefficient); }

Sum Sum::ascending(std::vector<std::pair<Monomial, Rational>> terms) {
  Sum result;
  for (auto& [monomial, coefficient] : terms)
    result.terms_.emplace_hint(result.terms_.end(), std::move(monomial), coefficient);
  return result;
}

void Sum::scale(const Rational& factor) {
  if (cln::zerop(factor)) terms_.clear();
  work::consume_budget(terms_.size());
  for (auto& [monomial, coefficient] : terms_) coefficient = factor * coefficient;
}

Sum& Sum::operator+=(const Sum& other) {
  for (const auto& [monomial, coefficient] : other.terms_) add(monomial, coefficient);
  if (terms_.size() > term_budget) throw TermBudget();
  return *this;
}

Sum& Sum::operator-=(const Sum& other) {
  for (const auto& [monomial, coefficient] : other.terms_) add(monomial, -coefficient);
  if (terms_.size() > term_budget) throw TermBudget();
  return *this;
}

Sum operator+(Sum a, const Sum& b) { return a += b; }
Sum operator-(Sum a, const Sum& b) { return a -= b; }
Sum operator-(const Sum& a) { return Rational(-1) * a; }

Sum operator*(const Rational& factor, const Sum& a) {
  Sum result = a;
  result.scale(factor);
  return result;
}

namespace {

template <class Take>
bool merge(const Monomial& a, const Monomial& b, const Take& take) {
  return symbolic::merge_powers(
      a, b, [](const Factor& x, const Factor& y) { return compare(*x.atom, *y.atom); }, take);
}

/// The product of factors with the same atom; one of them may be null.
Factor product_of(const Factor* x, const Factor* y) {
  if (y == nullptr) return *x;
  if (x == nullptr) return *y;
  return {x->atom, x->exponent + y->exponent};
}

/// The factors of both, unless a power of a sum becomes an integer power.
bool multiply_factors(const Monomial& a, const Monomial& b, Monomial& product) {
  product.clear();
  product.reserve(a.size() + b.size());
  return merge(a, b, [&](const Factor* x, const Factor* y) {
    Factor factor = product_of(x, y);
    if (cln::zerop(factor.exponent)) return true;
    if (is_whole_power_to_expand(factor)) return false;
    product.push_back(std::move(factor));
    return true;
  });
}

/// sum += coefficient a b; counts the operations of the product and of the sum.
void add_product(Sum& sum, const Monomial& a, const Monomial& b, const Rational& coefficient) {
  Monomial plain;
  if (multiply_factors(a, b, plain)) {
    work::consume_budget(1);
    sum.add(std::move(plain), coefficient);
    return;
  }
  const Sum product = multiply(a, b);
  for (const auto& [monomial, one] : product.terms()) sum.add(monomial, one * coefficient);
}

}  // namespace

Sum multiply(const Monomial& a, const Monomial& b) {
  Monomial product;
  if (multiply_factors(a, b, product)) return {std::move(product), 1};
  product.clear();
  Sum whole(1);
  merge(a, b, [&](const Factor* x, const Factor* y) {
    Factor factor = product_of(x, y);
    if (cln::zerop(factor.exponent)) return true;
    if (is_whole_power_to_expand(factor))
      whole = whole * power(factor.atom->args[0], factor.exponent);
    else
      product.push_back(std::move(factor));
    return true;
  });
  return Sum(std::move(product), 1) * whole;
}

Sum operator*(const Sum& a, const Sum& b) {
  if (a.size() * b.size() > 16 * term_budget) throw TermBudget();
  Sum result;
  for (const auto& [x, k] : a.terms()) {
    for (const auto& [y, l] : b.terms()) add_product(result, x, y, k * l);
  }
  if (result.size() > term_budget) throw TermBudget();
  return result;
}

Monomial inverse(const Monomial& monomial) {
  Monomial result = monomial;
  for (Factor& factor : result) factor.exponent = -factor.exponent;
  return result;
}

Content content(const Sum& sum) {
  Content result;
  if (sum.is_zero()) return result;
  cln::cl_I numerators = 0, denominators = 1;
  bool first = true;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    numerators = cln::gcd(numerators, cln::numerator(coefficient));
    denominators = cln::lcm(denominators, cln::denominator(coefficient));
    if (first) {
      result.monomial = monomial;
      first = false;
      continue;
    }
    Monomial common;  // least exponents; a missing factor counts as exponent 0
    merge(result.monomial, monomial, [&](const Factor* x, const Factor* y) {
      if (x != nullptr && y != nullptr)
        common.push_back({x->atom, x->exponent < y->exponent ? x->exponent : y->exponent});
      else if (const Factor& only = x != nullptr ? *x : *y; cln::minusp(only.exponent))
        common.push_back(only);
      return true;
    });
    result.monomial = std::move(common);
  }
  std::erase_if(result.monomial, [](const Factor& factor) { return cln::zerop(factor.exponent); });
  result.number = Rational(numerators) / denominators;
  return result;
}

Sum divide(const Sum& sum, const Content& by) {
  const Monomial reciprocal = inverse(by.monomial);
  Sum result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    add_product(result, monomial, reciprocal, coefficient / by.number);
  }
  return result;
}

bool contains(const Sum& sum, const Symbol& symbol) {
  bool found = false;
  for_each_atom(sum, [&](const Atom& atom) { found = found || (atom.op == Op::symbol && atom.symbol == symbol); });
  return found;
}

namespace {

/// Subtracts the factors of a sum, and those of the sums within them, from `left`; false if there are more.
bool take_factors(const Sum& sum, std::size_t& left) {
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      if (left == 0) return false;
      --left;
      for (const Sum& within : factor.atom->args) {
        if (!take_factors(within, left)) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool has_more_factors(const Sum& sum, std::size_t limit) { return !take_factors(sum, limit); }

}  // namespace eomgen::reading
