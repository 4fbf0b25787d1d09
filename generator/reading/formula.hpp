// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas ready for printing: a small tree with all choices of layout made - order, signs, brackets by precedence,
// fractions. The printers (print/) convert it to text, LaTeX and MathML and make no choices.
#pragma once

#include <string>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

enum class FormulaKind {
  number,  // exact, not negative
  pi,
  symbol,  // of the model
  mark,  // a letter of mechanics: T, U, L, Gamma, E, e, a, lambda, psi, ds^2 (`word`), with `lower` and `upper` indices
  call,  // op, args
  power,         // args[0] ^ args[1]
  negative,      // -args[0]
  product,       // args
  fraction,      // args[0] / args[1]
  sum,           // args; a term that is `negative` is subtracted
  rate,          // d/dt (args[0])
  partial,       // d args[0] / d args[1]
  dot,           // args[0] with `order` dots over it
  dot_product,   // args[0] . args[1]
  differential,  // d args[0]
  relation,      // args[0] = args[1] = ...; with `word` at_least: args[0] >= args[1]
  list,          // args, with commas
};

struct Formula {
  FormulaKind kind = FormulaKind::number;
  Rational number = 0;
  Symbol symbol{};
  Op op = Op::symbol;
  int order = 0;
  bool keeps_sign = false;  // of a sum: a bracket of the model, not to be shown as its negative
  std::string word;         // of a mark: "T", "tilde L", "Gamma", ...: see print/notation.hpp
  std::vector<Formula> args;
  std::vector<Formula> lower, upper;
};

inline constexpr const char* at_least = ">=";

Formula number(const Rational& value);  // negative values become a `negative` formula
Formula symbol(const Symbol& symbol);
Formula mark(std::string word, std::vector<Formula> lower = {}, std::vector<Formula> upper = {});
Formula negative(Formula a);  // -(-a) = a
Formula product(std::vector<Formula> factors);
Formula fraction(Formula above, Formula below);
Formula sum(std::vector<Formula> terms);  // of nested sums, flattened; 0 if empty
Formula relation(std::vector<Formula> sides);
Formula make_formula(FormulaKind form, std::vector<Formula> args);
bool is_zero(const Formula& f);

/// How sums are factored for display.
enum class Layout {
  terms,    // equations: every product of velocities or accelerations is a term of its own
  grouped,  // energies, reactions: common factors of terms of like kind are taken out
};
Formula arrange(const Sum& sum, Layout layout = Layout::grouped);
/// A sum of few terms with the factors taken out that save most: m g L x + k L^2 (x - y).
Formula arrange_by_factors(const Sum& sum);
/// arrange() with terms over common denominators joined, where their numerator has factors: (p - q cos(x))^2/(I
/// sin^2(x)) in place of three fractions.
Formula arrange_fractions(const Sum& sum, Layout layout = Layout::grouped);
/// The sum as a product of irreducible factors, for determinants.
Formula factored(const Sum& sum);
/// The terms of arrange(), each possibly `negative`.
std::vector<Formula> arranged_terms(const Sum& sum, Layout layout);
/// The terms of arrange_fractions(), each possibly `negative`.
std::vector<Formula> arranged_fractions(const Sum& sum, Layout layout);

}  // namespace eomgen::reading
