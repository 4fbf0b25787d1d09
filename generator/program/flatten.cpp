// SPDX-License-Identifier: GPL-3.0-or-later
// Rebuilds a graph bottom-up in normal form. Every other pass may leave aliases and chains behind; this one clears up.
#include <cln/rational.h>

#include <algorithm>

#include "program/polynomials.hpp"

namespace eomgen::program {
namespace {

using symbolic::Op;

bool is_odd(Op op) {
  return op == Op::sin || op == Op::tan || op == Op::asin || op == Op::atan || op == Op::sinh || op == Op::tanh ||
         op == Op::sign;
}
bool is_even(Op op) { return op == Op::cos || op == Op::cosh || op == Op::abs; }

class Flattening {
 public:
  Flattening(const Polynomials& from, bool inline_products)
      : from_(from), inline_products_(inline_products), value_(from.size()) {}

  Polynomials run() {
    const std::vector<NodeId> order = from_.order();
    uses_ = from_.uses(order);
    for (const NodeId id : order) value_[id] = value(id);
    for (const Term& result : from_.results) to_.results.push_back(to_.operand(translate(result)));
    for (const PivotPair& pair : from_.pivots) {
      to_.pivots.push_back({to_.operand(translate(pair.pivot)), to_.operand(translate(pair.scale))});
    }
    for (const Label& label : from_.labels) {
      // A label lives as long as its value is a value of its own.
      bool known = true;
      for (const Factor& f : label.value.factors) known = known && uses_[f.node] > 0;
      if (!known) continue;
      Label moved = label;
      moved.value = translate(label.value);
      if (moved.value.is_node()) to_.labels.push_back(std::move(moved));
    }
    return std::move(to_);
  }

 private:
  Term translate(const Term& term) {
    Term result{term.coefficient, {}};
    for (const Factor& f : term.factors) result = multiply(result, power_of(value_[f.node], f.exponent));
    return result;
  }
  Term power_of(const Term& base, std::int32_t exponent) {
    if (exponent == 1) return base;
    const bool unit = base.coefficient == 1 || base.coefficient == -1;
    // A divisor that turned out to be 0 stays a division by zero at run time; it must not be one here.
    if (base.coefficient == 0 && exponent < 0) return {1, {{to_.call(Op::div, {Term{1, {}}, Term{0, {}}}), 1}}};
    // Nor may untrusted exponents blow up exact numbers or overflow.
    constexpr std::int64_t largest_number = 64, largest = 1'000'000;
    if (base.is_constant() && !unit && std::abs(exponent) > largest_number) {
      return {1, {{to_.call(Op::pow, {base, Term{exponent, {}}}), 1}}};
    }
    bool small = unit || std::abs(exponent) <= largest_number;
    for (const Factor& f : base.factors) small = small && std::abs(std::int64_t{f.exponent} * exponent) <= largest;
    return power(small ? base : to_.operand(base), exponent);
  }

  Term value(NodeId id) {
    const Node& node = from_[id];
    if (node.kind == Node::Kind::leaf) return {1, {{to_.leaf(node.leaf), 1}}};
    if (node.kind == Node::Kind::call) return call(node);
    std::vector<Term> terms;
    terms.reserve(node.terms.size());
    for (const Term& term : node.terms) {
      Term moved = translate(term);
      if (moved.coefficient == 0) continue;
      if (node.terms.size() > 1 && may_splice(term, moved)) {
        for (Term inner : to_[moved.factors[0].node].terms) {
          if (cln::minusp(moved.coefficient)) inner.coefficient = -inner.coefficient;
          terms.push_back(std::move(inner));
        }
      } else {
        terms.push_back(std::move(moved));
      }
    }
    Term result = to_.normal(std::move(terms));
    const bool shared = uses_[id] > 1 && !inline_products_;
    if (shared && !result.is_constant() && !result.is_node()) result = to_.operand(result);
    return result;
  }

  /// A sum that only this sum uses becomes part of it.
  bool may_splice(const Term& old, const Term& moved) const {
    if (!moved.is_node() || to_[moved.factors[0].node].kind != Node::Kind::sum) return false;
    return old.factors.size() == 1 && old.factors[0].exponent == 1 && uses_[old.factors[0].node] == 1 &&
           to_[moved.factors[0].node].terms.size() > 1;
  }

  Term call(const Node& node) {
    std::vector<Term> arguments;
    for (const Term& argument : node.terms) arguments.push_back(to_.operand(translate(argument)));
    Rational sign = 1;
    if (cln::minusp(arguments[0].coefficient) && (is_odd(node.op) || is_even(node.op))) {
      arguments[0].coefficient = -arguments[0].coefficient;
      if (is_odd(node.op)) sign = -1;
    }
    return {sign, {{to_.call(node.op, std::move(arguments)), 1}}};
  }

  const Polynomials& from_;
  bool inline_products_;
  Polynomials to_;
  std::vector<Term> value_;
  std::vector<std::uint32_t> uses_;
};

}  // namespace

Polynomials flatten(const Polynomials& graph, bool inline_products) { return Flattening(graph, inline_products).run(); }

}  // namespace eomgen::program
