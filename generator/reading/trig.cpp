// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/trig.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "reading/rational_function.hpp"

namespace eomgen::reading {
namespace {

// Products of x, |x| and sign(x) in one form. In: a sum. Out: the same sum away from x = 0.

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

/// x^2/|x| -> |x|, x/|x| -> sign(x), |x| sign(x) -> x, sign(x)^2 -> 1, for every x that is one factor, such as sin(q).
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

constexpr int most_rounds = 6;

struct SumLess {
  bool operator()(const Sum& a, const Sum& b) const { return compare(a, b) < 0; }
};

bool is_call(const Factor& factor, Op op) {
  return factor.atom->op == op && is_integer(factor.exponent) && cln::plusp(factor.exponent);
}

Op dual(Op op) { return op == Op::sin ? Op::cos : Op::sin; }

std::vector<Sum> angles(const Sum& sum) {
  std::map<Sum, bool, SumLess> found;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      if ((is_call(factor, Op::sin) || is_call(factor, Op::cos)) && factor.exponent >= 2)
        found[factor.atom->args[0]] = true;
    }
  }
  std::vector<Sum> result;
  for (const auto& [angle, yes] : found) result.push_back(angle);
  return result;
}

// f^2 -> 1 - g^2 with f, g = sin, cos of `angle`.
Sum replace_square(const Sum& sum, Op f, const Sum& angle) {
  const Sum g = call(dual(f), {angle});
  const Sum other = Sum(1) - g * g;
  Sum result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Monomial rest = monomial;
    long pairs = 0;
    for (Factor& factor : rest) {
      if (!is_call(factor, f) || !(factor.atom->args[0] == angle)) continue;
      pairs = to_long(factor.exponent) / 2;
      factor.exponent = factor.exponent - 2 * pairs;
    }
    std::erase_if(rest, [](const Factor& factor) { return cln::zerop(factor.exponent); });
    if (pairs == 0)
      result.add(monomial, coefficient);
    else
      result += Sum(rest, coefficient) * power(other, pairs);
  }
  return result;
}

const Rational* coefficient_of(const Sum& sum, const Monomial& monomial) {
  const auto found = sum.terms().find(monomial);
  return found == sum.terms().end() ? nullptr : &found->second;
}

constexpr std::size_t operations_of_a_product = 2;  // the atom's and the product's

/// monomial atom^exponent, for an atom that is no sum under a power.
Monomial times(const Monomial& monomial, const AtomPtr& atom, long exponent) {
  work::consume_budget(operations_of_a_product);
  auto at = monomial.begin();
  int order = 1;
  for (; at != monomial.end(); ++at) {
    order = compare(*at->atom, *atom);
    if (order >= 0) break;
  }
  Monomial result;
  result.reserve(monomial.size() + 1);
  result.assign(monomial.begin(), at);
  if (at == monomial.end() || order > 0) {
    result.push_back({atom, exponent});
  } else {
    const Rational sum = at->exponent + exponent;
    if (!cln::zerop(sum)) result.push_back({at->atom, sum});
    ++at;
  }
  result.insert(result.end(), at, monomial.end());
  return result;
}

/// cos(x) for sin(x), and sin(x) for cos(x); each created once.
class Duals {
 public:
  const AtomPtr& operator()(const AtomPtr& atom) {
    AtomPtr& found = made_[atom];
    if (!found) found = call(dual(atom->op), {atom->args[0]}).terms().begin()->first.front().atom;
    return found;
  }

 private:
  std::unordered_map<AtomPtr, AtomPtr> made_;  // for lookup only
};

// k m f(a) g(b) + l m f'(a) g'(b), |k| = |l|, as one term; `a` and `b` are factors of `monomial`.
bool recombine_at(Sum& sum, const Monomial& monomial, const Rational& k, const Factor& a, const Factor& b,
                  Duals& duals) {
  const Sum &x = a.atom->args[0], &y = b.atom->args[0];
  const Op f = a.atom->op, g = b.atom->op;
  const Monomial rest = times(times(monomial, a.atom, -1), b.atom, -1);
  const Monomial partner = times(times(rest, duals(a.atom), 1), duals(b.atom), 1);
  const Rational* other = coefficient_of(sum, partner);
  if (other == nullptr || (*other != k && *other != -k)) return false;
  const bool same = *other == k;
  Sum merged;
  if (f == g) {
    // cos cos +- sin sin; starting from sin sin, the sign of the whole is that of its partner.
    const Rational sign = f == Op::cos || same ? Rational(1) : Rational(-1);
    merged = sign * call(Op::cos, {same ? x - y : x + y});
  } else {
    // f(x) g(y) is sin(x) cos(y), or cos(x) sin(y) with the roles exchanged.
    const Sum &s = f == Op::sin ? x : y, &c = f == Op::sin ? y : x;
    merged = call(Op::sin, {same ? s + c : s - c});
  }
  const Monomial self = monomial;
  const Rational coefficient = k, partner_coefficient = *other;
  sum.add(self, -coefficient);
  sum.add(partner, -partner_coefficient);
  sum += Sum(rest, coefficient) * merged;
  return true;
}

bool is_trig(const Factor& factor) { return is_call(factor, Op::sin) || is_call(factor, Op::cos); }

// Tries all pairs of sines and cosines of one term.
bool recombine_term(Sum& sum, const Monomial& monomial, const Rational& k, Duals& duals) {
  for (std::size_t i = 0; i < monomial.size(); ++i) {
    if (!is_trig(monomial[i])) continue;
    for (std::size_t j = i + 1; j < monomial.size(); ++j) {
      if (!is_trig(monomial[j]) || monomial[i].atom->args[0] == monomial[j].atom->args[0]) continue;
      if (recombine_at(sum, monomial, k, monomial[i], monomial[j], duals)) return true;
    }
  }
  return false;
}

// One pass; the search continues behind a merged term, so that long sums take one or two passes.
bool recombine_all(Sum& sum, Duals& duals) {
  bool changed = false;
  for (auto term = sum.terms().begin(); term != sum.terms().end();) {
    const Monomial monomial = term->first;
    const Rational k = term->second;
    if (recombine_term(sum, monomial, k, duals)) {
      changed = true;
      term = sum.terms().upper_bound(monomial);
    } else {
      ++term;
    }
  }
  return changed;
}

// {cos, sin} of a sum of angles or of a multiple of one.
std::pair<Sum, Sum> addition(const Sum& angle) {
  Sum c(1), s(0);
  for (const auto& [monomial, coefficient] : angle.terms()) {
    const cln::cl_I times = cln::numerator(coefficient);
    const Sum unit(monomial, Rational(1) / cln::denominator(coefficient));
    if (cln::abs(times) > 16) {
      const Sum whole(monomial, coefficient);
      std::tie(c, s) = std::pair(c * call(Op::cos, {whole}) - s * call(Op::sin, {whole}),
                                 s * call(Op::cos, {whole}) + c * call(Op::sin, {whole}));
      continue;
    }
    const Sum cu = call(Op::cos, {unit});
    const Sum su = cln::minusp(times) ? -call(Op::sin, {unit}) : call(Op::sin, {unit});
    for (long n = cln::cl_I_to_long(cln::abs(times)); n > 0; --n)
      std::tie(c, s) = std::pair(c * cu - s * su, s * cu + c * su);
  }
  return {c, s};
}

Sum expand_factor(const Factor& factor) {
  const Atom& atom = *factor.atom;
  if ((atom.op == Op::sin || atom.op == Op::cos) && is_integer(factor.exponent)) {
    const auto [c, s] = addition(expand_angles(atom.args[0]));
    return power(atom.op == Op::cos ? c : s, factor.exponent);
  }
  if (atom.op == Op::add) return power(expand_angles(atom.args[0]), factor.exponent);
  return Sum(Monomial{factor}, 1);
}

}  // namespace

Sum recombine_angles(const Sum& sum) {
  if (!may_recombine(sum)) return sum;
  Sum result = sum;
  Duals duals;
  while (recombine_all(result, duals)) {
  }
  return result;
}

Sum expand_angles(const Sum& sum) {
  Sum expanded;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Sum term(coefficient);
    for (const Factor& factor : monomial) term = term * expand_factor(factor);
    expanded += term;
  }
  for (const Sum& angle : angles(expanded)) expanded = replace_square(expanded, Op::sin, angle);
  return expanded;
}

Sum simplify(const Sum& sum) {
  Sum best = sum;
  for (int round = 0; round < most_rounds; ++round) {
    const Sum before = best;
    best = absorb_roots(cancel(recombine_angles(reduce_squares(reduce_signs(best)))));
    if (best == before) break;
  }
  return best;
}

}  // namespace eomgen::reading
