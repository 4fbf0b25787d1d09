// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/polynomial.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "symbolic/monomials.hpp"
#include "symbolic/small_numbers.hpp"
#include "work.hpp"

namespace eomgen::symbolic {
namespace {

// Higher powers of sums are not expanded: equations of motion do not need it.
constexpr long highest_expanded_power = 8;

void add_term(Polynomial& p, const Monomial& m, const Rational& coefficient) {
  add_like_term(p, m, coefficient, plus, [](const Rational& value) { return is_zero(value); });
}

Monomial product_of(const Monomial& a, const Monomial& b) { return product_of_powers<&Power::atom>(a, b); }

}  // namespace

std::optional<Ref> Expander::operator()(Ref expression) {
  const Maybe& expanded = expand(expression);
  if (!expanded) return std::nullopt;
  return rebuild(reduce(*expanded));
}

const Expander::Maybe& Expander::expand(Ref expression) {
  // Operands first, without recursion: their ids are smaller.
  for (const Ref r : dag_.reachable({expression})) {
    if (!memo_.contains(r.id)) {
      Maybe expanded = expand_node(r);
      memo_.emplace(r.id, std::move(expanded));
    }
  }
  return memo_.at(expression.id);
}

Polynomial Expander::atom(Ref r) const { return {{Monomial{{r, 1}}, Rational(1)}}; }

Expander::Maybe Expander::expand_node(Ref r) {
  work::throw_if_stopped();
  const Node node = dag_[r];
  const auto arg = [&](std::size_t i) -> const Maybe& { return memo_.at(node.args[i].id); };
  switch (node.op) {
    case Op::constant: {
      Polynomial p;
      add_term(p, {}, dag_.value(r));
      if (dag_.is_zero(r)) p.clear();
      return p;
    }
    case Op::pi:
    case Op::symbol: return atom(r);
    case Op::add:
    case Op::sub: {
      if (!arg(0) || !arg(1)) return std::nullopt;
      if (effort_ != nullptr && !effort_->consume(arg(0)->size() + arg(1)->size())) return std::nullopt;
      Polynomial sum = *arg(0);
      for (const auto& [m, c] : *arg(1)) add_term(sum, m, node.op == Op::add ? c : -c);
      if (sum.size() > budget_) return std::nullopt;
      return sum;
    }
    case Op::neg: {
      if (!arg(0)) return std::nullopt;
      Polynomial negated = *arg(0);
      for (auto& term : negated) term.second = -term.second;
      return negated;
    }
    case Op::mul:
      if (!arg(0) || !arg(1)) return std::nullopt;
      return product(*arg(0), *arg(1));
    case Op::div:
      if (!arg(0) || !arg(1)) return std::nullopt;
      return quotient(*arg(0), *arg(1));
    case Op::power: {
      if (!arg(0)) return std::nullopt;
      if (node.payload > highest_expanded_power && arg(0)->size() > 1) return with_simpler_arguments(r);
      if (powers_ == PowersOfDifferences::kept && is_difference(*arg(0))) {
        const Ref base = rebuild(reduce(*arg(0)));
        const bool negative = dag_[base].op == Op::neg;
        return Polynomial{{Monomial{{negative ? dag_[base].args[0] : base, node.payload}},
                           Rational(negative && node.payload % 2 != 0 ? -1 : 1)}};
      }
      Maybe power = *arg(0);
      if (power->size() == 1) {
        Monomial m = power->begin()->first;
        for (Power& factor : m) factor.exponent *= node.payload;
        return Polynomial{{m, cln::expt(power->begin()->second, node.payload)}};
      }
      for (std::int32_t i = 1; i < node.payload && power; ++i) power = product(*power, *arg(0));
      return power;
    }
    default: return with_simpler_arguments(r);
  }
}

/// Whether the sum is affine in a coordinate, a rate or a state.
bool Expander::is_difference(const Polynomial& p) const {
  const auto moves = [this](Ref atom) {
    const Node& node = dag_[atom];
    if (node.op != Op::symbol) return node.op != Op::pi;
    const SymbolKind kind = dag_.symbol_of(atom).kind;
    return kind != SymbolKind::parameter;
  };
  const auto is_affine = [&](const auto& term) {
    std::size_t moving = 0;
    bool states_only = true;
    for (const Power& factor : term.first) {
      if (!moves(factor.atom)) continue;
      ++moving;
      const bool symbol = dag_[factor.atom].op == Op::symbol && factor.exponent == 1;
      const SymbolKind kind = symbol ? dag_.symbol_of(factor.atom).kind : SymbolKind::time;
      states_only = states_only && (kind == SymbolKind::coordinate || kind == SymbolKind::state);
    }
    return moving == 1 && states_only;
  };
  return p.size() > 1 && std::any_of(p.begin(), p.end(), is_affine);
}

Expander::Maybe Expander::product(const Polynomial& a, const Polynomial& b) const {
  if (a.size() * b.size() > 16 * budget_) return std::nullopt;
  if (effort_ != nullptr && !effort_->consume(a.size() * b.size())) return std::nullopt;
  Polynomial result;
  for (const auto& [m, c] : a) {
    for (const auto& [n, d] : b) add_term(result, product_of(m, n), times(c, d));
  }
  if (result.size() > budget_) result = reduce(std::move(result));
  if (result.size() > budget_) return std::nullopt;
  return result;
}

Expander::Maybe Expander::quotient(const Polynomial& a, const Polynomial& b) {
  const Polynomial divisor = reduce(b);
  if (divisor.empty()) return std::nullopt;
  Polynomial inverse;
  if (divisor.size() == 1) {
    Monomial m = divisor.begin()->first;
    for (Power& factor : m) factor.exponent = -factor.exponent;
    inverse.emplace(std::move(m), cln::recip(divisor.begin()->second));
  } else {
    const Ref denominator = rebuild(divisor);
    // The sum becomes an atom with exponent -1, so that equal denominators combine.
    const bool negative = dag_[denominator].op == Op::neg;
    const Ref positive = negative ? dag_[denominator].args[0] : denominator;
    inverse.emplace(Monomial{{positive, -1}}, negative ? Rational(-1) : Rational(1));
  }
  return product(a, inverse);
}

// A function is an atom; its arguments are expanded separately.
Polynomial Expander::with_simpler_arguments(Ref r) {
  const Node node = dag_[r];
  std::array<Ref, 4> a{};
  for (std::uint8_t i = 0; i < node.arity; ++i) {
    const Maybe& argument = memo_.at(node.args[i].id);
    a[i] = argument ? rebuild(reduce(*argument)) : node.args[i];
  }
  Ref result;
  switch (node.op) {
    case Op::power: result = dag_.power(a[0], node.payload); break;
    case Op::pow: result = dag_.pow(a[0], a[1]); break;
    case Op::select: result = dag_.select(a[0], a[1], a[2], a[3]); break;
    case Op::atan2:
    case Op::min:
    case Op::max: result = dag_.call(node.op, a[0], a[1]); break;
    default: result = dag_.call(node.op, a[0]); break;
  }
  if (dag_.is_zero(result)) return {};
  if (dag_.is_constant(result)) return {{Monomial{}, dag_.value(result)}};
  if (dag_[result].op == Op::neg) return {{Monomial{{dag_[result].args[0], 1}}, Rational(-1)}};
  return atom(result);
}

std::optional<Polynomial> Expander::replace_square(const Polynomial& p, Ref square, Ref other) const {
  Polynomial result;
  bool any = false;
  for (const auto& [m, c] : p) {
    const auto factor = std::find_if(m.begin(), m.end(), [&](const Power& f) { return f.atom == square; });
    if (factor == m.end() || factor->exponent < 2) {
      add_term(result, m, c);
      continue;
    }
    any = true;
    const std::int64_t pairs = factor->exponent / 2;
    const Monomial rest = product_of(m, Monomial{{square, -2 * pairs}});
    // (1 - other^2)^pairs by the binomial theorem
    Rational binomial = 1;
    for (std::int64_t k = 0; k <= pairs; ++k) {
      const Monomial even = k == 0 ? Monomial{} : Monomial{{other, 2 * k}};
      add_term(result, product_of(rest, even), c * binomial);
      binomial = binomial * Rational(-(pairs - k)) / Rational(k + 1);
    }
    if (result.size() > 4 * budget_) return std::nullopt;
  }
  if (!any) return std::nullopt;
  return result;
}

Polynomial Expander::reduce(Polynomial p) const {
  std::set<Ref> angles;  // arguments of squared sines and cosines
  for (const auto& term : p) {
    for (const auto& [r, exponent] : term.first) {
      const Op op = dag_[r].op;
      if (exponent >= 2 && (op == Op::sin || op == Op::cos)) angles.insert(dag_[r].args[0]);
    }
  }
  Dag& dag = dag_;
  for (bool shorter = true; shorter;) {
    shorter = false;
    if (effort_ != nullptr && !effort_->consume(2 * angles.size() * p.size())) break;
    for (const Ref angle : angles) {
      const Ref sine = dag.call(Op::sin, angle), cosine = dag.call(Op::cos, angle);
      for (const auto& [square, other] : {std::pair{sine, cosine}, std::pair{cosine, sine}}) {
        std::optional<Polynomial> candidate = replace_square(p, square, other);
        if (!candidate || candidate->size() >= p.size()) continue;
        p = std::move(*candidate);
        shorter = true;
      }
    }
  }
  return p;
}

Ref Expander::rebuild_monomial(const Monomial& m, const Rational& coefficient) {
  Ref above = dag_.one(), below = dag_.one();
  for (const auto& [r, exponent] : m) {
    if (exponent > 0) above = dag_.mul(above, dag_.power(r, exponent));
    if (exponent < 0) below = dag_.mul(below, dag_.power(r, -exponent));
  }
  return dag_.mul(dag_.constant(coefficient), dag_.div(above, below));
}

/// Whether a value that is finite in binary64 may have an infinite divisor: 1 - c/cosh(x) is 1 for large x, and
/// (cosh(x) - c)/cosh(x) has no value.
bool Expander::may_overflow(Ref atom) {
  constexpr std::int32_t high_power = 8;
  const auto [known, is_new] = may_overflow_.try_emplace(atom.id, false);
  if (!is_new) return known->second;
  const std::vector<Ref> parts = dag_.reachable({atom});
  const bool result = std::any_of(parts.begin(), parts.end(), [this](Ref part) {
    const Node& node = dag_[part];
    return node.op == Op::exp || node.op == Op::cosh || node.op == Op::sinh || node.op == Op::pow ||
           (node.op == Op::power && node.payload >= high_power);
  });
  return may_overflow_[atom.id] = result;
}

// Common factors of all terms are factored out, and terms are put over one denominator, except for divisors that may
// overflow.
Ref Expander::rebuild(const Polynomial& p) {
  if (p.empty()) return dag_.zero();
  std::map<Ref, std::int64_t> common;
  for (const auto& [r, exponent] : p.begin()->first) common[r] = exponent;
  for (const auto& term : p) {
    std::map<Ref, std::int64_t> here;
    for (const auto& [r, exponent] : term.first) here.emplace(r, exponent);
    for (auto& [r, exponent] : common) {
      const auto found = here.find(r);
      exponent = std::min(exponent, found == here.end() ? std::int64_t{0} : found->second);
    }
    for (const auto& [r, exponent] : here) {
      if (exponent < 0) common.try_emplace(r, 0).first->second = std::min(common[r], exponent);
    }
  }
  for (auto& [r, exponent] : common) {
    if (exponent >= 0 || !may_overflow(r)) continue;
    exponent = std::numeric_limits<std::int64_t>::min();  // the divisor that all terms have
    for (const auto& term : p) {
      const auto found = std::find_if(term.first.begin(), term.first.end(),
                                      [atom = r](const Power& factor) { return factor.atom == atom; });
      exponent = std::max(exponent, found == term.first.end() ? std::int64_t{0} : found->exponent);
    }
    exponent = std::min(exponent, std::int64_t{0});
  }
  Monomial front, inverse;
  for (const auto& [r, exponent] : common) {
    if (exponent == 0) continue;
    front.push_back({r, exponent});
    inverse.push_back({r, -exponent});
  }
  Ref sum = dag_.zero();
  for (const auto& [m, c] : p) sum = dag_.add(sum, rebuild_monomial(product_of(m, inverse), c));
  Ref result = rebuild_monomial(front, Rational(1));
  return dag_.mul(result, sum);
}

Ref expand_or_keep(Dag& dag, Ref expression, std::size_t term_budget) {
  return Expander(dag, term_budget).expand_or_keep(expression);
}

Ref expand_if_shorter(Dag& dag, Ref expression, std::size_t term_budget, ProductBudget* effort) {
  const std::optional<Ref> expanded = Expander(dag, term_budget, effort)(expression);
  if (!expanded) return expression;
  return dag.reachable({*expanded}).size() <= dag.reachable({expression}).size() ? *expanded : expression;
}

}  // namespace eomgen::symbolic
