// SPDX-License-Identifier: GPL-3.0-or-later
// Normal form of sums. One program needs millions of them; most have one to four terms that are already sorted.
#include <cln/rational.h>

#include <algorithm>

#include "lists.hpp"
#include "program/polynomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::program {
namespace {

using symbolic::same;

bool before(const Term& a, const Term& b) { return a.factors < b.factors; }

void sort(std::vector<Term>& terms) {
  if (!std::is_sorted(terms.begin(), terms.end(), before)) std::stable_sort(terms.begin(), terms.end(), before);
}

/// Combines terms with the same monomial; drops zeros.
void collect(std::vector<Term>& terms) {
  sort(terms);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < terms.size();) {
    const std::size_t first = i++;
    for (; i < terms.size() && terms[i].factors == terms[first].factors; ++i) {
      terms[first].coefficient = symbolic::plus(terms[first].coefficient, terms[i].coefficient);
    }
    if (symbolic::is_zero(terms[first].coefficient)) continue;
    if (kept != first) terms[kept] = std::move(terms[first]);
    ++kept;
  }
  terms.resize(kept);
}

/// Reduces `common` to the factors that divide both monomials (negative exponents: that both divide by).
void keep_common(Monomial& common, const Monomial& other) {
  std::size_t kept = 0;
  auto g = other.begin();
  for (const Factor& f : common) {
    while (g != other.end() && g->node < f.node) ++g;
    if (g == other.end()) break;
    if (g->node != f.node || (g->exponent > 0) != (f.exponent > 0)) continue;
    common[kept++] = std::abs(g->exponent) < std::abs(f.exponent) ? *g : f;
  }
  common.truncate(kept);
}

/// The monomial and the number that divide every term (negative exponents: that every term divides by).
Term content(const std::vector<Term>& terms) {
  const Rational& first = terms[0].coefficient;
  Term result{1, terms[0].factors};
  const Rational opposite = -first;
  bool same_size = true;
  for (const Term& term : terms) {
    same_size = same_size && (same(term.coefficient, first) || same(term.coefficient, opposite));
    if (!result.factors.empty()) keep_common(result.factors, term.factors);
    if (!same_size && result.factors.empty()) break;
  }
  if (same_size) {
    result.coefficient = first;
  } else if (cln::minusp(first)) {
    result.coefficient = -1;
  }
  return result;
}

}  // namespace

bool PolynomialGraph::is_product(NodeId id) const {
  const Node& node = nodes_[id];
  return node.kind == Node::Kind::sum && node.terms.size() == 1 && symbolic::is_one(node.terms[0].coefficient);
}

Monomial PolynomialGraph::expanded(const Monomial& monomial) const {
  Monomial result;
  for (const Factor& f : monomial) {
    if (is_product(f.node))
      result = multiply(result, expanded(nodes_[f.node].terms[0].factors), f.exponent);
    else if (result.empty() || result.back().node < f.node)
      result.push_back(f);
    else
      result = multiply(result, {f});
  }
  return result;
}

/// The square of a sine or cosine in a term; products are expanded for the search.
bool PolynomialGraph::has_square(const Monomial& monomial) const {
  for (const Factor& f : monomial) {
    if (f.exponent >= 2 && is_trig(f.node)) return true;
  }
  if (std::none_of(monomial.begin(), monomial.end(), [this](const Factor& f) { return is_product(f.node); }))
    return false;
  const Monomial open = expanded(monomial);
  return std::any_of(open.begin(), open.end(), [this](const Factor& f) { return f.exponent >= 2 && is_trig(f.node); });
}

// c K sin^2 + c K cos^2 -> c K, and c K - c K cos^2 -> c K sin^2 if that sine exists. Products are expanded for the
// search, because squares may be hidden, as in (l cos)^2.
bool PolynomialGraph::apply_pythagoras(std::vector<Term>& terms) {
  if (std::none_of(terms.begin(), terms.end(), [this](const Term& term) { return has_square(term.factors); }))
    return false;
  std::vector<Monomial> open = mapped(terms, [&](const Term& term) { return expanded(term.factors); });
  const auto find = [&](const Monomial& wanted, const Rational& coefficient) {
    for (std::size_t j = 0; j < terms.size(); ++j) {
      if (same(terms[j].coefficient, coefficient) && open[j] == wanted) return j;
    }
    return terms.size();
  };
  for (std::size_t i = 0; i < terms.size(); ++i) {
    for (const Factor& f : open[i]) {
      NodeId other = 0;
      if (f.exponent < 2 || !find_trig_partner(f.node, other)) continue;
      const Monomial rest = multiply(open[i], {{f.node, 1}}, -2);
      const Monomial swapped = multiply(rest, {{other, 1}}, 2);
      std::size_t j = find(swapped, terms[i].coefficient);
      const bool one = j < terms.size();
      if (!one) j = find(rest, -terms[i].coefficient);
      if (j == terms.size() || j == i) continue;
      terms[i] = {terms[j].coefficient, one ? rest : swapped};
      terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(j));
      return true;
    }
  }
  return false;
}

Term PolynomialGraph::normalise(std::vector<Term> terms) {
  collect(terms);
  constexpr std::size_t longest = 400;  // the search for squares is quadratic
  while (terms.size() > 1 && terms.size() < longest && apply_pythagoras(terms)) collect(terms);
  if (terms.empty()) return {0, {}};
  if (terms.size() == 1) return std::move(terms[0]);
  Term front = content(terms);
  for (Term& term : terms) {
    term.coefficient = symbolic::quotient(term.coefficient, front.coefficient);
    if (!front.factors.empty()) term.factors = multiply(term.factors, front.factors, -1);
  }
  sort(terms);
  if (cln::minusp(terms[0].coefficient)) {
    // The division may have changed the first term; its coefficient is made positive.
    for (Term& term : terms) term.coefficient = -term.coefficient;
    front.coefficient = -front.coefficient;
  }
  return multiply(front, Term{1, {{sum(std::move(terms)), 1}}});
}

}  // namespace eomgen::program
