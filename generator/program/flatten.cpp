// SPDX-License-Identifier: GPL-3.0-or-later
// Rebuilds a graph bottom-up in normal form. Other passes may leave aliases and chains; this pass removes them.
#include <cln/rational.h>

#include <algorithm>
#include <set>

#include "program/polynomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::program {
namespace {

bool is_odd(Op op) {
  return op == Op::sin || op == Op::tan || op == Op::asin || op == Op::atan || op == Op::sinh || op == Op::tanh ||
         op == Op::sign;
}
bool is_even(Op op) { return op == Op::cos || op == Op::cosh || op == Op::abs; }

class Flattening {
 public:
  Flattening(const PolynomialGraph& from, bool inline_products, bool expand)
      : from_(from), inline_products_(inline_products), expand_(expand), value_(from.size()) {}

  PolynomialGraph run() {
    const std::vector<NodeId> order = from_.topological_order();
    uses_ = from_.use_counts(order);
    to_.reserve(order.size());
    to_.coordinates = from_.coordinates;
    if (expand_) find_barriers(), find_relative(order);
    for (const NodeId id : order) {
      value_[id] = value(id);
      if (expand_ && barrier_[id]) {
        for (const Factor& f : value_[id].factors) closed_.insert(f.node);
      }
    }
    for (const Term& result : from_.results) to_.results.push_back(to_.as_operand(translate(result)));
    for (const PivotPair& pair : from_.pivots) {
      to_.pivots.push_back({to_.as_operand(translate(pair.pivot)), to_.as_operand(translate(pair.scale))});
    }
    for (const Label& label : from_.labels) {
      // A label survives only if its value is still a node of its own.
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
    for (const Factor& f : term.factors) {
      if (f.exponent == 1)
        result = multiply(result, value_[f.node]);
      else
        result = multiply(result, power_of(value_[f.node], f.exponent));
    }
    while (combine_root(result.factors)) {
    }
    return result;
  }

  /// sqrt(s)^j s^k with the fewest factors: s^-1 sqrt(s) -> sqrt(s)^-1, sqrt(s)^2 -> s.
  bool combine_root(Monomial& factors) const {
    for (const Factor& root : factors) {
      const Node& node = to_[root.node];
      if (node.kind != Node::Kind::call || node.op != Op::sqrt || node.terms[0].factors.size() != 1) continue;
      const Term& square = node.terms[0];
      if (!symbolic::is_one(square.coefficient) || square.factors[0].exponent != 1) continue;
      const NodeId s = square.factors[0].node;
      std::int32_t whole = 0;
      for (const Factor& f : factors) whole += f.node == s ? f.exponent : 0;
      const std::int32_t halves = root.exponent + 2 * whole;
      const std::int32_t odd = halves % 2;  // 1, 0 or -1, with the sign of halves
      if (root.exponent == odd && whole == (halves - odd) / 2) continue;
      const Factor had = root;
      factors = multiply(factors, {{had.node, had.exponent}}, -1);
      if (whole != 0) factors = multiply(factors, {{s, whole}}, -1);
      if (odd != 0) factors = multiply(factors, {{had.node, odd}});
      if (halves != odd) factors = multiply(factors, {{s, (halves - odd) / 2}});
      return true;
    }
    return false;
  }
  Term power_of(const Term& base, std::int32_t exponent) {
    const bool unit = symbolic::is_unit(base.coefficient);
    // A divisor that is identically 0 stays a division by zero at run time; it must not be evaluated here.
    if (symbolic::is_zero(base.coefficient) && exponent < 0)
      return {1, {{to_.call(Op::div, {Term{1, {}}, Term{0, {}}}), 1}}};
    // Untrusted exponents must not overflow or produce huge exact numbers.
    constexpr std::int64_t largest_number = 64, largest = 1'000'000;
    if (base.is_constant() && !unit && std::abs(exponent) > largest_number) {
      return {1, {{to_.call(Op::pow, {base, Term{exponent, {}}}), 1}}};
    }
    bool small = unit || std::abs(exponent) <= largest_number;
    for (const Factor& f : base.factors) small = small && std::abs(std::int64_t{f.exponent} * exponent) <= largest;
    return power(small ? base : to_.as_operand(base), exponent);
  }

  Term value(NodeId id) {
    const Node& node = from_[id];
    if (node.kind == Node::Kind::leaf) return {1, {{to_.leaf(node.leaf), 1}}};
    if (node.kind == Node::Kind::call) return call(node);
    std::vector<Term> terms;
    terms.reserve(node.terms.size());
    for (const Term& term : node.terms) {
      Term moved = translate(term);
      if (symbolic::is_zero(moved.coefficient)) continue;
      if (expand_ && multiply_out(moved, relative_[id], terms)) continue;
      if (node.terms.size() > 1 && may_splice(term, moved)) {
        for (Term inner : to_[moved.factors[0].node].terms) {
          if (cln::minusp(moved.coefficient)) inner.coefficient = -inner.coefficient;
          terms.push_back(std::move(inner));
        }
      } else {
        terms.push_back(std::move(moved));
      }
    }
    Term result = to_.normalise(std::move(terms));
    const bool shared = uses_[id] > 1 && !inline_products_;
    if (shared && !result.is_constant() && !result.is_node()) result = to_.as_operand(result);
    return result;
  }

  /// Entries of M, f, A and the values of the solve stay separate; only their contents are expanded.
  void find_barriers() {
    barrier_.assign(from_.size(), false);
    for (const Label& label : from_.labels) {
      for (const Factor& f : label.value.factors) barrier_[f.node] = true;
    }
    for (const PivotPair& pair : from_.pivots) {
      for (const Factor& f : pair.pivot.factors) barrier_[f.node] = true;
    }
  }

  /// Nodes whose relative error matters: divisors, arguments of functions, and what these consist of.
  void find_relative(const std::vector<NodeId>& order) {
    relative_.assign(from_.size(), false);
    for (auto id = order.rbegin(); id != order.rend(); ++id) {
      const Node& node = from_[*id];
      for (const Term& term : node.terms) {
        for (const Factor& f : term.factors)
          relative_[f.node] = relative_[f.node] || relative_[*id] || node.kind == Node::Kind::call || f.exponent < 0;
      }
    }
  }

  /// A difference such as x - L: affine in a coordinate, or in a rate if `rates`. It may be small beside its summands,
  /// and its square loses all digits there if it is multiplied out: x^2 - 2 x L + L^2.
  bool may_cancel(const Node& sum, bool rates) const {
    const auto is_leaf_of = [this](const Factor& f, bool state) {
      const Node& node = to_[f.node];
      return node.kind == Node::Kind::leaf && (node.leaf.slot == Slot::state) == state;
    };
    const auto is_rate = [this](const Factor& f) {
      const std::uint32_t place = to_[f.node].leaf.index;
      return place >= from_.coordinates && place < 2 * from_.coordinates;
    };
    return std::any_of(sum.terms.begin(), sum.terms.end(), [&](const Term& term) {
      std::size_t states = 0, others = 0;
      for (const Factor& f : term.factors) {
        if (f.exponent == 1 && is_leaf_of(f, true) && (rates || !is_rate(f)))
          ++states;
        else if (!is_leaf_of(f, false))
          ++others;
      }
      return states == 1 && others == 0;
    });
  }

  /// Adds the summands of a product of sums to `terms` if they are few.
  bool multiply_out(const Term& term, bool relative, std::vector<Term>& terms) const {
    constexpr std::size_t most = 36;
    std::vector<Term> products{{term.coefficient, {}}};
    bool opened = false;
    for (const Factor& f : term.factors) {
      const Node& node = to_[f.node];
      const bool open = node.kind == Node::Kind::sum && node.terms.size() > 1 && !closed_.contains(f.node);
      if (!open || f.exponent < 1 || f.exponent > 2 || (f.exponent == 2 && may_cancel(node, relative))) {
        for (Term& product : products) product.factors = multiply(product.factors, {f});
        continue;
      }
      for (std::int32_t k = 0; k < f.exponent; ++k) {
        if (products.size() * node.terms.size() > most) return false;
        std::vector<Term> next;
        for (const Term& a : products) {
          for (const Term& b : node.terms) next.push_back(multiply(a, b));
        }
        products = std::move(next);
      }
      opened = true;
    }
    if (opened) terms.insert(terms.end(), products.begin(), products.end());
    return opened;
  }

  /// Merges a sum that only this sum uses.
  bool may_splice(const Term& old, const Term& moved) const {
    if (!moved.is_node() || to_[moved.factors[0].node].kind != Node::Kind::sum) return false;
    return old.factors.size() == 1 && old.factors[0].exponent == 1 && uses_[old.factors[0].node] == 1 &&
           to_[moved.factors[0].node].terms.size() > 1;
  }

  Term call(const Node& node) {
    std::vector<Term> arguments;
    for (const Term& argument : node.terms) arguments.push_back(to_.as_operand(translate(argument)));
    Rational sign = 1;
    if (cln::minusp(arguments[0].coefficient) && (is_odd(node.op) || is_even(node.op))) {
      arguments[0].coefficient = -arguments[0].coefficient;
      if (is_odd(node.op)) sign = -1;
    }
    return {sign, {{to_.call(node.op, std::move(arguments)), 1}}};
  }

  const PolynomialGraph& from_;
  bool inline_products_, expand_;
  PolynomialGraph to_;
  std::vector<bool> barrier_, relative_;  // nodes of from_
  std::set<NodeId> closed_;               // nodes of to_
  std::vector<Term> value_;
  std::vector<std::uint32_t> uses_;
};

}  // namespace

PolynomialGraph flatten(const PolynomialGraph& graph, bool inline_products) {
  return Flattening(graph, inline_products, false).run();
}

PolynomialGraph expand(const PolynomialGraph& graph) { return Flattening(graph, true, true).run(); }

}  // namespace eomgen::program
