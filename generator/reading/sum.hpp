// SPDX-License-Identifier: GPL-3.0-or-later
// The canonical form of displayed equations: a sum of monomials with exact coefficients, over atoms (symbols, function
// calls, sums under a power). The order is by kind, then by order of declaration. GiNaC's order is not used, since it
// changes from process to process. Products are always expanded here; layout.cpp factors them again for display.
#pragma once

#include <cln/rational.h>

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "symbolic/dag.hpp"
#include "work.hpp"

namespace eomgen::reading {

using symbolic::Op;
using symbolic::Rational;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

class Sum;
struct Atom;
using AtomPtr = std::shared_ptr<const Atom>;

/// Thrown if an expression has too many terms to display. Callers then show it by parts.
struct TermBudget : work::BudgetExceeded {
  TermBudget() : work::BudgetExceeded("too many terms to be written out") {}
};
inline constexpr std::size_t term_budget = 3000;

struct Factor {
  AtomPtr atom;
  Rational exponent;
};
/// Factors in the order of compare(Atom, Atom), each atom once, no exponent zero.
using Monomial = std::vector<Factor>;

int compare(const Atom& a, const Atom& b);
int compare(const Monomial& a, const Monomial& b);
int compare(const Sum& a, const Sum& b);

struct MonomialLess {
  bool operator()(const Monomial& a, const Monomial& b) const { return compare(a, b) < 0; }
};

class Sum {
 public:
  using Terms = std::map<Monomial, Rational, MonomialLess>;

  Sum() = default;
  Sum(long value) { add({}, Rational(value)); }
  explicit Sum(const Rational& value) { add({}, value); }
  explicit Sum(AtomPtr atom) { add({{std::move(atom), 1}}, 1); }
  Sum(Monomial monomial, const Rational& coefficient) { add(std::move(monomial), coefficient); }

  /// Builds a sum from ascending terms, none of them 0.
  static Sum ascending(std::vector<std::pair<Monomial, Rational>> terms);

  void add(const Monomial& monomial, const Rational& coefficient);
  void add(Monomial&& monomial, const Rational& coefficient);
  const Terms& terms() const { return terms_; }
  std::size_t size() const { return terms_.size(); }
  bool is_zero() const { return terms_.empty(); }
  bool is_number() const { return terms_.empty() || (terms_.size() == 1 && terms_.begin()->first.empty()); }
  Rational number() const { return terms_.empty() ? Rational(0) : terms_.begin()->second; }

  Sum& operator+=(const Sum& other);
  Sum& operator-=(const Sum& other);
  /// Multiplies every term.
  void scale(const Rational& factor);

 private:
  template <class Key>
  void add_term(Key&& monomial, const Rational& coefficient);
  Terms terms_;
};

Sum operator+(Sum a, const Sum& b);
Sum operator-(Sum a, const Sum& b);
Sum operator-(const Sum& a);
/// Throws work::BudgetExceeded by its number of terms, or by the operations of the whole calculation (reading.hpp).
Sum operator*(const Sum& a, const Sum& b);
Sum operator*(const Rational& factor, const Sum& a);
inline bool operator==(const Sum& a, const Sum& b) { return compare(a, b) == 0; }

/// A symbol (Op::symbol), pi, a function call, a sum under a power (Op::add; args[0] is its base, primitive), or a
/// power with a non-numeric exponent (Op::pow).
struct Atom {
  Op op = Op::symbol;
  Symbol symbol{};
  std::vector<Sum> args;
  bool positive = false;            // known to be > 0
  bool is_half_turn_angle = false;  // an angle in (0, pi)
};

/// Product of two monomials as a sum. Powers of sums whose exponents become integers are expanded.
Sum multiply(const Monomial& a, const Monomial& b);
/// x^exponent: expanded for integer exponents >= 0. Otherwise the common factor is pulled out, with sqrt(x^2) = |x|, or
/// x if x is known to be positive.
Sum power(const Sum& x, const Rational& exponent);
/// A function call with its sign pulled out: sin(-x) = -sin(x), cos(-x) = cos(x).
Sum call(Op function, std::vector<Sum> args);

/// The largest monomial (negative exponents included) and positive rational that divide every term.
struct Content {
  Rational number = 1;
  Monomial monomial;
};
Content content(const Sum& sum);
/// sum / monomial, sum / number: exact.
Sum divide(const Sum& sum, const Content& by);
Monomial inverse(const Monomial& monomial);

/// Whether the sum, with the sums within it, is written with more factors than `limit`.
bool has_more_factors(const Sum& sum, std::size_t limit);

/// Whether the term displayed first has a negative coefficient; decides which sign is pulled out of brackets.
bool has_negative_leading_term(const Sum& sum);
/// Terms in display order: accelerations, velocities, coordinates, the rest.
std::vector<std::pair<Monomial, Rational>> display_order(const Sum& sum);

/// Calls `visit` for every atom, including those in arguments.
template <class Visit>
void for_each_atom(const Sum& sum, Visit&& visit) {
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) for_each_atom(factor, visit);
  }
}
template <class Visit>
void for_each_atom(const Factor& factor, Visit&& visit) {
  visit(*factor.atom);
  for (const Sum& arg : factor.atom->args) for_each_atom(arg, visit);
}
bool contains(const Sum& sum, const Symbol& symbol);
bool is_one(const Rational& r);
bool is_integer(const Rational& r);
/// The exponent as a long; only for integers of reasonable size.
long to_long(const Rational& r);

}  // namespace eomgen::reading
