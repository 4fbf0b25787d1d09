// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/power_of_sum.hpp"

#include <algorithm>
#include <optional>

#include "reading/ginac_bridge.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

using GiNaC::ex;
using symbolic::Node;

// Lines break between terms, never inside a bracket. Untrusted models have potentials of any size.
constexpr std::size_t longest_base = 6, most_powers = 64, most_nodes = 2000, longest_sum = 300,
                      most_operations = 200'000;
constexpr long largest_exponent = 8;

bool is_motion(const Atom& atom) {
  return atom.op == Op::symbol && atom.symbol.order > 0 &&
         (atom.symbol.kind == SymbolKind::coordinate || atom.symbol.kind == SymbolKind::function);
}

bool is_sine_or_cosine(const Atom& atom) { return atom.op == Op::sin || atom.op == Op::cos; }

bool has_factor(const Monomial& monomial, bool (*is_wanted)(const Atom&)) {
  bool found = false;
  for (const Factor& factor : monomial)
    for_each_atom(factor, [&](const Atom& atom) { found = found || is_wanted(atom); });
  return found;
}

bool is_constant_term(const Monomial& monomial) {
  return !has_factor(monomial, [](const Atom& atom) {
    return atom.op == Op::symbol && (atom.symbol.kind == SymbolKind::coordinate ||
                                     atom.symbol.kind == SymbolKind::state || atom.symbol.kind == SymbolKind::integral);
  });
}

bool has_constant_term(const Sum& base) {
  return std::any_of(base.terms().begin(), base.terms().end(),
                     [](const auto& term) { return is_constant_term(term.first); });
}

/// Whether a base reads better with the other sign: r - l0 and x2 - x1 - l0 for l0 - r and x1 - x2 + l0, x2 - x1 for
/// x1 - x2, y - h cos(b) for h cos(b) - y.
bool reads_better_negated(const Sum& base) {
  bool has_moving_minus = false, adds_constant = false, subtracts_constant = false;
  std::optional<bool> last_is_subtracted, last_plain_is_subtracted;
  for (const auto& [monomial, coefficient] : display_order(base)) {
    const bool minus = cln::minusp(coefficient);
    if (is_constant_term(monomial)) {
      (minus ? subtracts_constant : adds_constant) = true;
      continue;
    }
    has_moving_minus = has_moving_minus || minus;
    last_is_subtracted = minus;
    if (!has_factor(monomial, is_sine_or_cosine)) last_plain_is_subtracted = minus;
  }
  if (adds_constant || subtracts_constant) return adds_constant && !subtracts_constant && has_moving_minus;
  return last_plain_is_subtracted ? *last_plain_is_subtracted : last_is_subtracted.value_or(false);
}

/// The common factor that is taken out of a base: s - 1/2 stays, as the model has it.
Content factor_of_base(const Sum& base) {
  Content common = content(base);
  if (!is_integer(common.number)) common.number = 1;
  return common;
}

class Collector {
 public:
  Collector(const mechanics::Mechanics& m, GinacBridge& bridge, const std::map<Symbol, Sum>& values)
      : dag_(*m.dag), bridge_(bridge), values_(values) {}

  std::vector<PowerOfSum> collect(Ref potential) {
    terms(potential, 1, [&](Ref term, const ex& sign) { product(term, sign); });
    return std::move(found_);
  }

  /// Differences such as x - l0 that a force law multiplies.
  std::vector<PowerOfSum> collect_differences(const std::vector<std::vector<Ref>>& forces) {
    const auto add_factor = [&](Ref term) {
      const std::optional<Ref> factor = only_sum(term, nullptr);
      if (factor && is_sum(*factor)) add_difference(*factor);
      return factor;
    };
    for (const std::vector<Ref>& components : forces) {
      for (const Ref component : components) {
        terms(component, 1, [&](Ref term, const ex&) {
          const std::optional<Ref> factor = add_factor(term);
          if (factor && is_sum(*factor)) terms(*factor, 1, [&](Ref inner, const ex&) { add_factor(inner); });
        });
      }
    }
    return std::move(found_);
  }

 private:
  /// The terms of a sum, with their signs.
  template <class Action>
  void terms(Ref root, const ex& factor, Action&& action) {
    std::vector<std::pair<Ref, ex>> open{{root, factor}};
    for (std::size_t count = 0; !open.empty() && count < most_nodes; ++count) {
      const auto [r, c] = open.back();
      open.pop_back();
      const Node& n = dag_[r];
      if (n.op == Op::add || n.op == Op::sub) {
        open.emplace_back(n.args[1], n.op == Op::sub ? ex(-c) : c);
        open.emplace_back(n.args[0], c);
      } else if (n.op == Op::neg) {
        open.emplace_back(n.args[0], -c);
      } else {
        action(r, c);
      }
    }
  }

  bool is_sum(Ref r) const { return dag_[r].op == Op::add || dag_[r].op == Op::sub; }

  /// The factor of a product that is a sum or a power of one, if there is just one; the others go into `rest`.
  std::optional<Ref> only_sum(Ref r, ex* rest) {
    std::optional<Ref> result;
    std::vector<Ref> open{r};
    for (std::size_t count = 0; !open.empty(); ++count) {
      if (count == most_nodes) return std::nullopt;
      const Ref factor = open.back();
      const Node& n = dag_[factor];
      open.pop_back();
      if (n.op == Op::mul) {
        open.push_back(n.args[0]);
        open.push_back(n.args[1]);
      } else if (n.op == Op::div) {
        open.push_back(n.args[0]);
        if (rest != nullptr) *rest = *rest / bridge_.from_dag(n.args[1]);
      } else if (is_sum(factor) || (n.op == Op::power && is_sum(n.args[0]))) {
        if (result) return std::nullopt;
        result = factor;
      } else if (rest != nullptr) {
        *rest = *rest * bridge_.from_dag(factor);
      }
    }
    return result;
  }

  void product(Ref r, ex coefficient) {
    const std::optional<Ref> factor = only_sum(r, &coefficient);
    if (!factor) return;
    if (dag_[*factor].op == Op::power) return add(*factor, coefficient, found_);
    // k ((x - a)^2 + y^2)/2: only if no squares of its terms merge, as those of sines and cosines do.
    std::vector<PowerOfSum> inside;
    terms(*factor, coefficient, [&](Ref term, ex c) {
      const std::optional<Ref> inner = only_sum(term, &c);
      if (inner && dag_[*inner].op == Op::power) add(*inner, c, inside);
    });
    if (inside.empty()) return;
    std::size_t size = 0;
    terms(*factor, coefficient, [&](Ref term, const ex& c) { size += imposed(c * bridge_.from_dag(term)).size(); });
    if (imposed(coefficient * bridge_.from_dag(*factor)).size() != size) return;
    inside.resize(std::min(inside.size(), most_powers - found_.size()));
    found_.insert(found_.end(), inside.begin(), inside.end());
  }

  Sum imposed(const ex& e) { return bridge_.substitute(bridge_.from_ginac(e), values_); }

  void add(Ref power_node, const ex& factor, std::vector<PowerOfSum>& found) {
    PowerOfSum result{imposed(factor), imposed(bridge_.from_dag(dag_[power_node].args[0])), dag_[power_node].payload};
    if (found.size() >= most_powers || result.exponent > largest_exponent) return;
    if (result.coefficient.size() != 1 || result.base.size() < 2 || result.base.size() > longest_base) return;
    const Content common = factor_of_base(result.base);
    result.base = divide(result.base, common);
    const bool minus = reads_better_negated(result.base);
    if (minus) result.base = -result.base;
    const Sum outside(common.monomial, minus ? -common.number : common.number);
    result.coefficient = result.coefficient * power(outside, Rational(result.exponent));
    if (result.coefficient.size() == 1) found.push_back(std::move(result));
  }

  void add_difference(Ref sum) {
    std::size_t size = 0;
    terms(sum, 1, [&](Ref, const ex&) { ++size; });
    if (size > longest_base || found_.size() >= most_powers) return;
    Sum base = imposed(bridge_.from_dag(sum));
    if (base.size() < 2 || base.size() > longest_base) return;
    base = divide(base, factor_of_base(base));
    if (reads_better_negated(base)) base = -base;
    bool has_place = false, subtracts_constant = false;
    for (const auto& [monomial, coefficient] : base.terms()) {
      if (has_factor(monomial, is_motion) || (is_constant_term(monomial) && cln::plusp(coefficient))) return;
      subtracts_constant = subtracts_constant || is_constant_term(monomial);
      has_place = has_place || (!is_constant_term(monomial) && !has_factor(monomial, is_sine_or_cosine));
    }
    const bool is_known =
        std::any_of(found_.begin(), found_.end(), [&](const PowerOfSum& other) { return other.base == base; });
    if (has_place && subtracts_constant && !is_known) found_.push_back({Sum(), std::move(base), 1});
  }

  const symbolic::Dag& dag_;
  GinacBridge& bridge_;
  const std::map<Symbol, Sum>& values_;
  std::vector<PowerOfSum> found_;
};

AtomPtr bracket_atom(const Sum& base) {
  Atom atom;
  atom.op = Op::pow;
  atom.args = {base, Sum(1)};
  return std::make_shared<const Atom>(std::move(atom));
}

/// coefficient * [base]^exponent, not expanded.
Sum with_bracket(const Sum& coefficient, const Sum& base, long exponent) {
  const Monomial factor{{bracket_atom(base), Rational(exponent)}};
  Sum result;
  for (const auto& [monomial, number] : coefficient.terms()) result += number * multiply(monomial, factor);
  return result;
}

/// The sum of k c over all k with k * terms(c * expanded) among the terms without motion of `left`, which loses them.
Sum take_multiples(Sum& left, const Sum& expanded) {
  Sum result;
  const auto& [pivot, pivot_number] = *expanded.terms().begin();
  const Monomial reciprocal = inverse(pivot);
  const std::vector<std::pair<Monomial, Rational>> candidates(left.terms().begin(), left.terms().end());
  for (const auto& [monomial, number] : candidates) {
    if (has_factor(monomial, is_motion)) continue;
    const auto present = left.terms().find(monomial);
    if (present == left.terms().end() || present->second != number) continue;
    const Sum factor = number / pivot_number * multiply(monomial, reciprocal);
    if (factor.size() != 1) continue;
    const Sum all = factor * expanded;
    const bool divides =
        all.size() == expanded.size() && std::all_of(all.terms().begin(), all.terms().end(), [&](const auto& term) {
          const auto found = left.terms().find(term.first);
          return found != left.terms().end() && found->second == term.second;
        });
    if (!divides) continue;
    left -= all;
    result += factor;
  }
  return result;
}

/// Whether terms of both depend on the coordinates alike, so that they read as one: (k1 + k2) x1.
bool shares_coordinates(const Sum& a, const Sum& b) {
  const auto moving = [](const Monomial& monomial) {
    Monomial result;
    for (const Factor& factor : monomial) {
      if (!is_constant_term({factor})) result.push_back(factor);
    }
    return result;
  };
  return std::any_of(a.terms().begin(), a.terms().end(), [&](const auto& x) {
    return std::any_of(b.terms().begin(), b.terms().end(),
                       [&](const auto& y) { return compare(moving(x.first), moving(y.first)) == 0; });
  });
}

/// The coefficient's own sum as a second bracket: k (x - a) (s - l0)/s in place of two terms. Parameters stay outside.
Sum with_common_factors(const Sum& coefficient) {
  if (coefficient.size() < 2 || coefficient.size() > longest_base) return coefficient;
  const Content common = content(coefficient);
  Sum rest = divide(coefficient, common);
  bool moves = false;
  for (const auto& [monomial, number] : rest.terms()) moves = moves || !is_constant_term(monomial);
  if (!moves) return coefficient;
  // x - a, not a - x; differences without a constant take the sign of their factor.
  const bool all_alike = std::all_of(rest.terms().begin(), rest.terms().end(), [&](const auto& term) {
    return cln::minusp(term.second) == cln::minusp(rest.terms().begin()->second);
  });
  const bool minus =
      all_alike ? has_negative_leading_term(rest) : has_constant_term(rest) && reads_better_negated(rest);
  return with_bracket(Sum(common.monomial, minus ? -common.number : common.number), minus ? -rest : rest, 1);
}

}  // namespace

bool is_bracket(const Atom& atom) { return atom.op == Op::pow && atom.args[1] == Sum(1); }

std::vector<PowerOfSum> powers_of_sums(const mechanics::Mechanics& m, GinacBridge& bridge,
                                       const std::map<Symbol, Sum>& values) {
  std::vector<PowerOfSum> result = Collector(m, bridge, values).collect(m.potential);
  for (PowerOfSum& difference : Collector(m, bridge, values).collect_differences(m.force_components))
    result.push_back(std::move(difference));
  return result;
}

std::vector<PowerOfSum> powers_of_sums(const mechanics::Mechanics& m) {
  try {
    const work::Budget budget(most_operations);
    GinacBridge bridge(m);
    return powers_of_sums(m, bridge, {});
  } catch (const work::BudgetExceeded&) {
    return {};
  }
}

Sum with_powers(const Sum& potential, const std::vector<PowerOfSum>& powers) try {
  if (powers.empty() || potential.size() > longest_sum) return potential;
  const auto expanded = [](const PowerOfSum& p) {
    return simplify(p.coefficient * power(p.base, Rational(p.exponent)));
  };
  Sum all, kept;
  for (const PowerOfSum& p : powers) {
    all += expanded(p);
    kept += with_bracket(p.coefficient, p.base, p.exponent);
  }
  const Sum rest = simplify(potential - all);
  if (rest.size() + kept.size() <= potential.size()) return rest + kept;
  Sum left = potential;  // without those that make it longer
  kept = {};
  for (const PowerOfSum& p : powers) {
    Sum without = simplify(left - expanded(p));
    if (without.size() >= left.size()) continue;
    left = std::move(without);
    kept += with_bracket(p.coefficient, p.base, p.exponent);
  }
  return left + kept;
} catch (const work::BudgetExceeded&) {
  return potential;
}

Sum with_brackets(const Sum& sum, const std::vector<PowerOfSum>& powers) try {
  if (powers.empty() || sum.size() < 2 || sum.size() > longest_sum) return sum;
  Sum left = sum, kept;
  const auto take = [&](const PowerOfSum& p, long exponent) {
    const Sum before = left;
    const Sum taken = take_multiples(left, simplify(power(p.base, Rational(exponent))));
    if (taken.is_zero()) return;
    if (exponent == 1 && !has_constant_term(p.base) && shares_coordinates(left, before - left))
      left = before;
    else
      kept += with_bracket(with_common_factors(taken), p.base, exponent);
  };
  for (const PowerOfSum& p : powers) {
    for (long exponent = p.exponent; exponent > 1; --exponent) take(p, exponent);
    if (has_constant_term(p.base)) take(p, 1);
  }
  for (const PowerOfSum& p : powers) {
    if (!has_constant_term(p.base)) take(p, 1);
  }
  return left + kept;
} catch (const work::BudgetExceeded&) {
  return sum;
}

}  // namespace eomgen::reading
