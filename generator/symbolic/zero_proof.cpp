// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/zero_proof.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "symbolic/calculus.hpp"

namespace eomgen::symbolic {
namespace {

constexpr std::size_t proof_terms = 4000;
constexpr long most_multiples = 6;  // of an angle: sin(6 x) is taken apart, sin(7 x) is a thing of its own
constexpr std::uint32_t first_symbol = 0x40000000u;  // of SymbolKind::auxiliary; nobody else goes that high

/// num / product of den, each to its power.
struct Fraction {
  Ref num;
  std::map<Ref, long> den;
};

class RationalForm {
 public:
  explicit RationalForm(Dag& dag) : dag_(dag) {}

  const Fraction& operator()(Ref expression) {
    for (const Ref r : dag_.reachable({expression})) {
      if (!memo_.contains(r.id)) {
        Fraction fraction = of_node(r);
        memo_.emplace(r.id, std::move(fraction));
      }
    }
    return memo_.at(expression.id);
  }

 private:
  Fraction whole(Ref r) const { return {r, {}}; }

  Ref times_missing(Ref num, const std::map<Ref, long>& has, const std::map<Ref, long>& all) const {
    for (const auto& [factor, exponent] : all) {
      const auto found = has.find(factor);
      num = dag_.mul(num, dag_.power(factor, exponent - (found == has.end() ? 0 : found->second)));
    }
    return num;
  }

  Fraction sum(const Fraction& a, const Fraction& b, bool minus) const {
    std::map<Ref, long> den = a.den;
    for (const auto& [factor, exponent] : b.den) den[factor] = std::max(den[factor], exponent);
    const Ref left = times_missing(a.num, a.den, den), right = times_missing(b.num, b.den, den);
    return {minus ? dag_.sub(left, right) : dag_.add(left, right), std::move(den)};
  }
  Fraction product(const Fraction& a, const Fraction& b) const {
    Fraction result{dag_.mul(a.num, b.num), a.den};
    for (const auto& [factor, exponent] : b.den) result.den[factor] += exponent;
    return result;
  }
  Fraction reciprocal(const Fraction& a) const {
    Fraction result{times_missing(dag_.one(), {}, a.den), {}};
    if (!dag_.is_one(a.num)) result.den[a.num] = 1;
    return result;
  }
  Fraction power(const Fraction& a, long exponent) const {
    Fraction result{dag_.power(a.num, exponent), a.den};
    for (auto& factor : result.den) factor.second *= exponent;
    return result;
  }

  Ref fresh(Ref argument, std::map<Ref, Ref>& known) {
    const auto found = known.find(argument);
    if (found != known.end()) return found->second;
    return known[argument] = dag_.symbol({SymbolKind::auxiliary, first_symbol + next_++, 0});
  }

  /// Sine and cosine of an angle, by the formulas for sums and multiples.
  std::pair<Fraction, Fraction> sine_cosine(Ref angle) {
    const Node node = dag_[angle];
    if (node.op == Op::neg) {
      auto [s, c] = sine_cosine(node.args[0]);
      s.num = dag_.neg(s.num);
      return {s, c};
    }
    if (node.op == Op::add || node.op == Op::sub) return of_sum(node.args[0], node.args[1], node.op == Op::sub);
    if (node.op == Op::mul && dag_.is_constant(node.args[0])) {
      const Rational factor = dag_.value(node.args[0]);
      if (cln::denominator(factor) == 1 && cln::abs(factor) <= most_multiples && factor >= 2) {
        return of_sum(dag_.mul(dag_.constant(factor - 1), node.args[1]), node.args[1], false);
      }
    }
    const Ref w = fresh(angle, half_tangents_);
    const Ref square = dag_.power(w, 2), below = dag_.add(dag_.one(), square);
    return {{dag_.mul(dag_.integer(2), w), {{below, 1}}}, {dag_.sub(dag_.one(), square), {{below, 1}}}};
  }
  std::pair<Fraction, Fraction> of_sum(Ref a, Ref b, bool minus) {
    const auto [sa, ca] = sine_cosine(a);
    const auto [sb, cb] = sine_cosine(b);
    return {sum(product(sa, cb), product(ca, sb), minus), sum(product(ca, cb), product(sa, sb), !minus)};
  }

  Fraction of_node(Ref r) {
    const Node node = dag_[r];
    const auto arg = [&](std::size_t i) -> const Fraction& { return memo_.at(node.args[i].id); };
    switch (node.op) {
      case Op::add: return sum(arg(0), arg(1), false);
      case Op::sub: return sum(arg(0), arg(1), true);
      case Op::neg: return {dag_.neg(arg(0).num), arg(0).den};
      case Op::mul: return product(arg(0), arg(1));
      case Op::div: return product(arg(0), reciprocal(arg(1)));
      case Op::power: return power(arg(0), node.payload);
      case Op::sin: return sine_cosine(node.args[0]).first;
      case Op::cos: return sine_cosine(node.args[0]).second;
      case Op::tan: {
        const auto [s, c] = sine_cosine(node.args[0]);
        return product(s, reciprocal(c));
      }
      case Op::exp: return whole(fresh(node.args[0], exponentials_));
      case Op::sinh:
      case Op::cosh: {
        const Ref e = fresh(node.args[0], exponentials_), square = dag_.power(e, 2);
        const Ref num = node.op == Op::sinh ? dag_.sub(square, dag_.one()) : dag_.add(square, dag_.one());
        return {num, {{dag_.mul(dag_.integer(2), e), 1}}};
      }
      case Op::tanh: {
        const Ref square = dag_.power(fresh(node.args[0], exponentials_), 2);
        return {dag_.sub(square, dag_.one()), {{dag_.add(square, dag_.one()), 1}}};
      }
      default: return whole(r);
    }
  }

  Dag& dag_;
  std::unordered_map<std::uint32_t, Fraction> memo_;
  std::map<Ref, Ref> half_tangents_, exponentials_;
  std::uint32_t next_ = 0;
};

/// Extracts s^(n/2) from sqrt(s)^n, which an expansion leaves as one atom.
Ref roots_split(Dag& dag, Ref expression) {
  std::unordered_map<std::uint32_t, Ref> memo;
  for (const Ref r : dag.reachable({expression})) {
    const Node node = dag[r];
    std::array<Ref, 4> args{};
    bool changed = false;
    for (std::uint8_t i = 0; i < node.arity; ++i) {
      args[i] = memo.at(node.args[i].id);
      changed = changed || args[i] != node.args[i];
    }
    Ref result = changed ? with_operands(dag, node, args) : r;
    const Node power = dag[result];
    if (power.op == Op::power && dag[power.args[0]].op == Op::sqrt) {
      const Ref root = power.args[0], whole = dag.power(dag[root].args[0], power.payload / 2);
      result = power.payload % 2 == 0 ? whole : dag.mul(whole, root);
    }
    memo.emplace(r.id, result);
  }
  return memo.at(expression.id);
}

}  // namespace

bool is_proven_zero(Dag& dag, Ref expression, ProductBudget* effort) {
  constexpr int most_rounds = 4;  // of roots inside of roots
  RationalForm form(dag);
  Expander expander(dag, proof_terms, effort);
  for (int round = 0; round < most_rounds; ++round) {
    if (dag.is_zero(expression)) return true;
    const Ref numerator = form(expression).num;
    if (dag.is_zero(numerator)) return true;
    const std::optional<Ref> expanded = expander(numerator);
    if (!expanded) return false;
    if (dag.is_zero(*expanded)) return true;
    const Ref next = roots_split(dag, *expanded);
    if (next == expression) return false;
    expression = next;
  }
  return false;
}

}  // namespace eomgen::symbolic
