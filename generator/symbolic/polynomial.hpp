// SPDX-License-Identifier: GPL-3.0-or-later
// Expansion of expressions into sums of products over atoms (symbols, sines, roots, ...). sin^2 + cos^2 = 1 is applied
// in the direction that leaves fewer terms. In: a Ref. Out: a Ref of equal value with at most the budgeted terms.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>

#include "symbolic/dag.hpp"
#include "symbolic/small_vector.hpp"

namespace eomgen::symbolic {

/// A power of an atom, with an exponent of any sign.
struct Power {
  Ref atom;
  std::int64_t exponent = 1;
  friend auto operator<=>(const Power&, const Power&) = default;
};
using Monomial = SmallVector<Power, 4>;  // ascending by atom; no exponent is 0
/// Monomials with nonzero coefficients.
using Polynomial = std::map<Monomial, Rational>;

/// A budget of products of two terms. The count is the same on every machine.
struct ProductBudget {
  std::size_t left = 0;

  bool consume(std::size_t products) {
    const bool enough = products <= left;
    left = enough ? left - products : 0;
    return enough;
  }
};

/// What becomes of (x - L)^2, the power of a distance or of a difference of rates. It may be small beside x^2, and
/// x^2 - 2 L x + L^2 has no correct digit there: programs keep the power, proofs multiply it out.
enum class PowersOfDifferences : std::uint8_t { expanded, kept };

class Expander {
 public:
  /// No result has more than `term_budget` terms. Expansion stops once `effort` is exhausted.
  explicit Expander(Dag& dag, std::size_t term_budget = 400, ProductBudget* effort = nullptr,
                    PowersOfDifferences powers = PowersOfDifferences::expanded)
      : dag_(dag), budget_(term_budget), effort_(effort), powers_(powers) {}

  /// The expanded and reduced form; nothing if it exceeds the budget.
  std::optional<Ref> operator()(Ref expression);
  /// The expanded form, or the unchanged expression if it exceeds the budget.
  Ref expand_or_keep(Ref expression) { return (*this)(expression).value_or(expression); }

 private:
  using Maybe = std::optional<Polynomial>;
  const Maybe& expand(Ref r);
  Maybe expand_node(Ref r);
  Maybe product(const Polynomial& a, const Polynomial& b) const;
  Maybe quotient(const Polynomial& a, const Polynomial& b);
  Polynomial atom(Ref r) const;
  bool is_difference(const Polynomial& p) const;
  Polynomial with_simpler_arguments(Ref r);
  Polynomial reduce(Polynomial p) const;
  std::optional<Polynomial> replace_square(const Polynomial& p, Ref square, Ref other) const;
  Ref rebuild(const Polynomial& p);
  Ref rebuild_monomial(const Monomial& m, const Rational& coefficient);
  bool may_overflow(Ref atom);

  Dag& dag_;
  std::size_t budget_;
  ProductBudget* effort_;
  PowersOfDifferences powers_;
  std::unordered_map<std::uint32_t, Maybe> memo_;
  std::unordered_map<std::uint32_t, bool> may_overflow_;
};

/// Expander::expand_or_keep for one expression.
Ref expand_or_keep(Dag& dag, Ref expression, std::size_t term_budget = 400);
/// The expanded form if it has no more nodes, else the unchanged expression.
Ref expand_if_shorter(Dag& dag, Ref expression, std::size_t term_budget, ProductBudget* effort = nullptr);

}  // namespace eomgen::symbolic
