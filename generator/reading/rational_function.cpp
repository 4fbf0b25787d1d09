// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/rational_function.hpp"

#include <ginac/ginac.h>

#include <algorithm>
#include <set>

#include "reading/exact_division.hpp"

namespace eomgen::reading {
namespace {

using GiNaC::ex;

// Factoring is limited to sums that a person would factor.
constexpr std::size_t factored_terms = 24;
constexpr std::size_t divided_terms = 400;

struct AtomLess {
  bool operator()(const AtomPtr& a, const AtomPtr& b) const { return compare(*a, *b) < 0; }
};

/// Polynomials over atoms as GiNaC polynomials over symbols. GiNaC orders symbols by hash values that differ between
/// processes, and its factorisation starts from the first symbol: with some orders, it does not end within minutes.
/// Therefore the n-th atom of the sum is given the n-th symbol of GiNaC's order.
class PolynomialLetters {
 public:
  explicit PolynomialLetters(const Sum& sum) {
    std::set<AtomPtr, AtomLess> atoms;
    for (const auto& [monomial, coefficient] : sum.terms()) {
      for (const Factor& factor : monomial) atoms.insert(factor.atom);
    }
    std::set<ex, GiNaC::ex_is_less> symbols;
    while (symbols.size() < atoms.size()) symbols.insert(GiNaC::symbol());
    for (auto symbol = symbols.begin(); const AtomPtr& atom : atoms) {
      letters_.emplace(atom, *symbol);
      meaning_.emplace(*symbol++, atom);
    }
  }

  /// Empty if an exponent is negative or no integer.
  std::optional<ex> polynomial(const Sum& sum) const {
    ex result = 0;
    for (const auto& [monomial, coefficient] : sum.terms()) {
      ex term = GiNaC::numeric(coefficient);
      for (const Factor& factor : monomial) {
        if (!is_integer(factor.exponent) || cln::minusp(factor.exponent)) return std::nullopt;
        term *= GiNaC::pow(letters_.at(factor.atom), static_cast<long>(to_long(factor.exponent)));
      }
      result += term;
    }
    return result;
  }

  /// The symbols that the polynomial contains, those of the lowest degree first.
  std::vector<ex> by_degree(const ex& polynomial) const {
    std::vector<ex> result;
    for (const auto& [atom, symbol] : letters_) {
      if (polynomial.degree(symbol) > 0) result.push_back(symbol);
    }
    std::stable_sort(result.begin(), result.end(),
                     [&](const ex& a, const ex& b) { return polynomial.degree(a) < polynomial.degree(b); });
    return result;
  }

  Sum sum(const ex& e) const {
    if (GiNaC::is_a<GiNaC::numeric>(e)) return Sum(cln::the<cln::cl_RA>(GiNaC::ex_to<GiNaC::numeric>(e).to_cl_N()));
    if (GiNaC::is_a<GiNaC::symbol>(e)) return Sum(meaning_.at(e));
    if (GiNaC::is_a<GiNaC::power>(e)) return power(sum(e.op(0)), GiNaC::ex_to<GiNaC::numeric>(e.op(1)).to_long());
    const bool adds = GiNaC::is_a<GiNaC::add>(e);
    Sum result(adds ? 0 : 1);
    for (std::size_t i = 0; i < e.nops(); ++i) result = adds ? result + sum(e.op(i)) : result * sum(e.op(i));
    return result;
  }

 private:
  std::map<AtomPtr, ex, AtomLess> letters_;
  std::map<ex, AtomPtr, GiNaC::ex_is_less> meaning_;
};

void add_factor(Factorisation& result, Sum factor, long exponent) {
  if (factor.is_number()) return;  // the numeric content is known up to its sign
  factor = divide(factor, Content{content(factor).number, {}});
  if (has_negative_leading_term(factor)) factor = -factor;
  for (auto& [known, times] : result.factors) {
    if (known == factor) {
      times += exponent;
      return;
    }
  }
  result.factors.emplace_back(std::move(factor), exponent);
}

/// The polynomials whose product is `e`, each with its exponent, without numbers.
std::vector<std::pair<ex, long>> powers_of(const ex& e) {
  std::vector<std::pair<ex, long>> result;
  const auto add = [&](const ex& factor) {
    if (GiNaC::is_a<GiNaC::numeric>(factor)) return;
    if (GiNaC::is_a<GiNaC::power>(factor)) {
      result.emplace_back(factor.op(0), GiNaC::ex_to<GiNaC::numeric>(factor.op(1)).to_long());
    } else {
      result.emplace_back(factor, 1);
    }
  };
  if (!GiNaC::is_a<GiNaC::mul>(e)) {
    add(e);
    return result;
  }
  for (std::size_t i = 0; i < e.nops(); ++i) add(e.op(i));
  return result;
}

/// Whether a polynomial whose coefficients in x have no common divisor is shown to be irreducible: with numbers for the
/// other symbols, it keeps its degree in x and is irreducible over the rational numbers. False means unknown.
bool has_irreducible_image(const ex& polynomial, const ex& x, const std::vector<ex>& symbols) {
  constexpr int images = 4;
  for (int image = 1; image <= images; ++image) {
    GiNaC::exmap numbers;
    long number = image;
    for (const ex& symbol : symbols) {
      if (!symbol.is_equal(x)) numbers[symbol] = number;
      number = number > 0 ? -number : image - number + 1;
    }
    const ex univariate = polynomial.subs(numbers).expand();
    if (univariate.degree(x) != polynomial.degree(x)) continue;
    const auto factors = powers_of(GiNaC::factor(univariate));
    if (factors.size() == 1 && factors.front().second == 1) return true;
  }
  return false;
}

/// Adds the factors of an expanded polynomial. If it is a y + b with a symbol y that neither a nor b contains, then
/// (a y + b) / gcd(a, b) has no further factor: it is primitive and of degree 1 in y. Lifting factors of an image to
/// several symbols, which can take minutes, is left to polynomials that neither this nor an image settles.
void add_factors(Factorisation& result, const PolynomialLetters& letters, const ex& polynomial) {
  const std::vector<ex> symbols = letters.by_degree(polynomial);
  const auto common_divisor = [&](const ex& x) {
    if (polynomial.degree(x) > 1) return polynomial.content(x);
    return GiNaC::gcd(polynomial.coeff(x, 1), polynomial.coeff(x, 0));
  };
  const ex common = common_divisor(symbols.front()).expand();
  if (!GiNaC::is_a<GiNaC::numeric>(common)) {
    ex rest;
    if (!GiNaC::divide(polynomial, common, rest)) throw std::logic_error("a common divisor does not divide");
    add_factors(result, letters, common);
    add_factors(result, letters, rest.expand());
    return;
  }
  if (polynomial.degree(symbols.front()) == 1 || has_irreducible_image(polynomial, symbols.front(), symbols)) {
    add_factor(result, letters.sum(polynomial), 1);
    return;
  }
  for (const auto& [factor, exponent] : powers_of(GiNaC::factor(polynomial)))
    add_factor(result, letters.sum(factor.expand()), exponent);
}

/// Whether a sum is irreducible as c x m + rest with the atom x in no other term: a divisor must divide m, and only 1
/// divides all terms.
bool is_irreducible(const Sum& primitive) {
  std::map<AtomPtr, int, AtomLess> times;
  for (const auto& [monomial, coefficient] : primitive.terms()) {
    for (const Factor& factor : monomial) times[factor.atom] += is_one(factor.exponent) ? 1 : 2;
  }
  return std::any_of(times.begin(), times.end(), [](const auto& atom) { return atom.second == 1; });
}

}  // namespace

Factorisation factorise(const Sum& whole) {
  Factorisation result;
  result.content = content(whole);
  Sum primitive = divide(whole, result.content);
  if (has_negative_leading_term(primitive)) {
    result.sign = -1;
    primitive = -primitive;
  }
  if (primitive.is_number()) return result;
  if (primitive.size() <= factored_terms && is_irreducible(primitive)) {
    work::consume_budget(display_operation_count(primitive) + 2 * primitive.size());
    result.factors.emplace_back(primitive, 1);
    return result;
  }
  std::optional<ex> polynomial;
  const PolynomialLetters letters(primitive.size() <= factored_terms ? primitive : Sum(0));
  if (primitive.size() <= factored_terms) polynomial = letters.polynomial(primitive);
  if (!polynomial) {
    result.factors.emplace_back(primitive, 1);
    return result;
  }
  add_factors(result, letters, polynomial->expand());
  std::sort(result.factors.begin(), result.factors.end(),
            [](const auto& a, const auto& b) { return compare(a.first, b.first) < 0; });
  return result;
}

std::optional<Sum> exact_quotient(const Sum& a, const Sum& b) {
  if (a.is_zero()) return a;
  if (a.size() > divided_terms || b.size() > divided_terms) return std::nullopt;
  return divide_exactly(a, b);
}

namespace {

/// Caches factorisations of sums in denominators: the same sums recur.
using Factorisations = std::map<AtomPtr, Factorisation, AtomLess>;

Sum cancel_whole(const Sum& sum, Factorisations& known) {
  // The largest power of every sum in a denominator.
  std::map<AtomPtr, Rational, AtomLess> under;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      if (factor.atom->op != Op::add || !is_integer(factor.exponent) || cln::plusp(factor.exponent)) continue;
      Rational& most = under.try_emplace(factor.atom, 0).first->second;
      if (-factor.exponent > most) most = -factor.exponent;
    }
  }
  if (under.empty() || sum.size() > divided_terms) return sum;
  Sum numerator = sum, rest(1);
  std::vector<std::pair<Sum, long>> bases;
  for (const auto& [atom, exponent] : under) {
    numerator = numerator * Sum(Monomial{{atom, exponent}}, 1);
    auto found = known.find(atom);
    if (found == known.end()) found = known.emplace(atom, factorise(atom->args[0])).first;
    const Factorisation& parts = found->second;
    rest = rest * power(Sum(parts.content.monomial, parts.sign * parts.content.number), -exponent);
    for (const auto& [base, times] : parts.factors) bases.emplace_back(base, times * to_long(exponent));
  }
  // An expanded product with x^-1 of a sum may contain positive integer powers of it, which are sums now.
  Sum result = rest;
  for (auto& [base, times] : bases) {
    for (std::optional<Sum> q; times > 0 && (q = exact_quotient(numerator, base)); --times) numerator = *q;
    if (times > 0) result = result * power(base, -times);
  }
  result = result * numerator;
  return result.size() <= sum.size() ? result : sum;
}

/// The sums in denominators, and the atoms in them.
std::set<AtomPtr, AtomLess> atoms_of_denominators(const Sum& sum) {
  std::set<AtomPtr, AtomLess> result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      if (factor.atom->op != Op::add || !cln::minusp(factor.exponent)) continue;
      result.insert(factor.atom);
      for (const auto& [inner, k] : factor.atom->args[0].terms()) {
        for (const Factor& f : inner) result.insert(f.atom);
      }
    }
  }
  return result;
}

}  // namespace

// First each part with its own other factors (x_dot (a^2 + b^2)/(a^2 + b^2) + ..), then the whole.
Sum cancel(const Sum& sum) {
  const std::set<AtomPtr, AtomLess> below = atoms_of_denominators(sum);
  if (below.empty() || sum.size() > divided_terms) return sum;
  std::map<Monomial, Sum, MonomialLess> parts;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Monomial outside, inside;
    for (const Factor& factor : monomial) (below.contains(factor.atom) ? inside : outside).push_back(factor);
    parts[outside].add(inside, coefficient);
  }
  Factorisations known;
  if (parts.size() < 2) return cancel_whole(sum, known);
  Sum result;
  for (const auto& [outside, part] : parts) result += Sum(outside, 1) * cancel_whole(part, known);
  return cancel_whole(result.size() <= sum.size() ? result : sum, known);
}

Sum absorb_roots(const Sum& sum) {
  if (sum.size() < 2) return sum;
  for (const Factor& root : content(sum).monomial) {
    if (root.atom->op != Op::add || is_integer(root.exponent)) continue;
    const Sum base = root.atom->args[0];
    Sum rest = divide(sum, {1, {root}});
    Rational exponent = root.exponent;
    if (base.size() < 2) continue;  // a single term always divides
    for (std::optional<Sum> q; rest.size() > 1 && (q = exact_quotient(rest, base)); exponent = exponent + 1) rest = *q;
    if (exponent != root.exponent) return rest * Sum(Monomial{{root.atom, exponent}}, 1);
  }
  return sum;
}

Sum quotient(const Sum& a, const Sum& b) { return cancel(a * power(b, -1)); }

}  // namespace eomgen::reading
