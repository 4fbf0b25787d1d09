// SPDX-License-Identifier: GPL-3.0-or-later
// The order of all printed expressions: by kind, then by order of declaration. It does not use addresses, serial
// numbers or hashes, so that every process prints the same.
#include <algorithm>
#include <array>
#include <iterator>

#include "reading/power_of_sum.hpp"

namespace eomgen::reading {
namespace {

// The order of the factors of a product: 2 lambda m d^2 R sin(phi)^2 d_dot theta_dot.
constexpr int coordinates = 6, calls = 7, rates = 8, accelerations = 10, last_rank = 11;
constexpr int rank_of(SymbolKind kind, int order) {
  switch (kind) {
    case SymbolKind::multiplier:
    case SymbolKind::friction:
    case SymbolKind::contact_mode: return 1;
    case SymbolKind::parameter: return 2;
    case SymbolKind::input: return 3;
    case SymbolKind::function: return order == 0 ? 4 : order == 1 ? rates : accelerations;
    case SymbolKind::integral: return 4;
    case SymbolKind::state: return coordinates;
    case SymbolKind::time: return 5;
    case SymbolKind::vector:
    case SymbolKind::branch:
    case SymbolKind::auxiliary: return 5;
    case SymbolKind::coordinate: return order == 0 ? coordinates : order == 1 ? rates + 1 : accelerations + 1;
  }
  return calls;
}

// Orders from 2 on are accelerations.
constexpr std::size_t kinds = static_cast<std::size_t>(SymbolKind::vector) + 1, orders = 3;
constexpr auto symbol_ranks = [] {
  std::array<std::array<int, orders>, kinds> ranks{};
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    for (std::size_t order = 0; order < orders; ++order)
      ranks[kind][order] = rank_of(static_cast<SymbolKind>(kind), static_cast<int>(order));
  }
  return ranks;
}();

int rank(const Atom& atom) {
  if (atom.op == Op::pi) return 0;
  if (atom.op != Op::symbol) return calls;
  return symbol_ranks[static_cast<std::size_t>(atom.symbol.kind)][std::min<std::size_t>(atom.symbol.order, orders - 1)];
}

int sign_of(bool less, bool greater) { return less ? -1 : greater ? 1 : 0; }

// Almost all exponents and coefficients are small integers, which CLN stores as tagged words.
int compare_numbers(const Rational& a, const Rational& b) {
  if (a.word == b.word) return 0;
  if (cln::cl_immediate_p(a.word) && cln::cl_immediate_p(b.word)) {
    const auto value = [](cln::cl_uint word) { return static_cast<cln::cl_sint>(word); };
    return sign_of(value(a.word) < value(b.word), value(a.word) > value(b.word));
  }
  return cln::compare(a, b);
}

// The degree of each kind in a term, in order: accelerations, rates, rates of coordinates, positions.
using Weight = std::array<Rational, 4>;

void weigh(const Monomial& monomial, Weight& weight) {
  for (const Factor& factor : monomial) {
    const int r = rank(*factor.atom);
    if (r >= accelerations)
      weight[0] += factor.exponent;
    else if (r >= rates)
      weight[1] += factor.exponent;
    if (r == rates + 1) weight[2] += factor.exponent;
    if (r == coordinates || r == calls) weight[3] += 1;
  }
}

// Compares monomials from the factors of one rank on, in display order.
int compare_from(const Monomial& a, const Monomial& b, int first, int last) {
  const auto inside = [&](const Factor& f) { return rank(*f.atom) >= first && rank(*f.atom) <= last; };
  auto i = std::find_if(a.begin(), a.end(), inside), j = std::find_if(b.begin(), b.end(), inside);
  while (true) {
    const bool more_a = i != a.end() && inside(*i), more_b = j != b.end() && inside(*j);
    if (!more_a || !more_b) return sign_of(more_a, more_b);  // the longer one first
    if (const int c = compare(*i->atom, *j->atom); c != 0) return c;
    if (const int c = compare_numbers(j->exponent, i->exponent); c != 0) return c;  // x^2 before x
    ++i;
    ++j;
  }
}

int compare_display(const Monomial& a, const Monomial& b) {
  Weight weight_a{}, weight_b{};
  weigh(a, weight_a);
  weigh(b, weight_b);
  for (std::size_t k = 0; k < 3; ++k) {
    if (const int c = compare_numbers(weight_b[k], weight_a[k]); c != 0) return c;
  }
  if (const int c = compare_from(a, b, accelerations, last_rank); c != 0) return c;
  if (const int c = compare_from(a, b, rates, rates + 1); c != 0) return c;
  if ((weight_a[3] > 0) != (weight_b[3] > 0)) return weight_a[3] > 0 ? -1 : 1;
  if (const int c = compare_from(a, b, coordinates, coordinates); c != 0) return c;
  if (const int c = compare_from(a, b, calls, calls); c != 0) return c;
  return compare_from(a, b, 0, coordinates - 1);
}

/// A term with the first terms of its brackets in their place: k (r - l0) stands where k r would.
Monomial opened(const Monomial& monomial) {
  Monomial result;
  std::copy_if(monomial.begin(), monomial.end(), std::back_inserter(result),
               [](const Factor& f) { return !is_bracket(*f.atom); });
  for (const Factor& factor : monomial) {
    if (!is_bracket(*factor.atom)) continue;
    const Monomial first = display_order(factor.atom->args[0]).front().first;
    for (Rational n = factor.exponent; cln::plusp(n); n = n - 1)
      result = multiply(result, first).terms().begin()->first;
  }
  return result;
}

int compare_placed(const Monomial& a, const Monomial& b) {
  const auto has_bracket = [](const Monomial& monomial) {
    return std::any_of(monomial.begin(), monomial.end(), [](const Factor& f) { return is_bracket(*f.atom); });
  };
  if (!has_bracket(a) && !has_bracket(b)) return compare_display(a, b);
  return compare_display(opened(a), opened(b));
}

}  // namespace

int compare(const Atom& a, const Atom& b) {
  if (&a == &b) return 0;
  const int rank_a = rank(a), rank_b = rank(b);
  if (rank_a != rank_b) return sign_of(rank_a < rank_b, true);
  if (a.op == Op::symbol && b.op == Op::symbol) {
    const auto order = a.symbol <=> b.symbol;
    return sign_of(order<0, order> 0);
  }
  if (a.op == Op::pi && b.op == Op::pi) return 0;
  // sin(x) cos(x) sin(y) cos(y) cos(x - y): by argument first, simple ones before sums
  const std::size_t common = std::min(a.args.size(), b.args.size());
  if (common > 0 && a.args[0].size() != b.args[0].size()) return sign_of(a.args[0].size() < b.args[0].size(), true);
  for (std::size_t i = 0; i < common; ++i) {
    if (const int c = compare(a.args[i], b.args[i]); c != 0) return c;
  }
  if (a.args.size() != b.args.size()) return sign_of(a.args.size() < b.args.size(), true);
  return sign_of(a.op < b.op, b.op < a.op);
}

int compare(const Monomial& a, const Monomial& b) {
  const std::size_t common = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (const int c = compare(*a[i].atom, *b[i].atom); c != 0) return c;
    if (const int c = compare_numbers(b[i].exponent, a[i].exponent); c != 0) return c;
  }
  return sign_of(a.size() > b.size(), a.size() < b.size());
}

int compare(const Sum& a, const Sum& b) {
  auto i = a.terms().begin(), j = b.terms().begin();
  for (; i != a.terms().end() && j != b.terms().end(); ++i, ++j) {
    if (const int c = compare(i->first, j->first); c != 0) return c;
    if (const int c = compare_numbers(i->second, j->second); c != 0) return c;
  }
  return sign_of(i == a.terms().end() && j != b.terms().end(), j == b.terms().end() && i != a.terms().end());
}

std::vector<std::pair<Monomial, Rational>> display_order(const Sum& sum) {
  std::vector<std::pair<Monomial, Rational>> terms(sum.terms().begin(), sum.terms().end());
  std::stable_sort(terms.begin(), terms.end(),
                   [](const auto& a, const auto& b) { return compare_placed(a.first, b.first) < 0; });
  return terms;
}

bool has_negative_leading_term(const Sum& sum) {
  if (sum.is_zero()) return false;
  auto first = sum.terms().begin();
  for (auto term = std::next(first); term != sum.terms().end(); ++term) {
    if (compare_placed(term->first, first->first) < 0) first = term;
  }
  return cln::minusp(first->second);
}

}  // namespace eomgen::reading
