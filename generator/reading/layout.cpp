// SPDX-License-Identifier: GPL-3.0-or-later
// Converts canonical sums to conventional notation: m (R_dot^2 + R^2 phi_dot^2)/2 in place of three products. Terms are
// grouped by their velocities and accelerations, coefficients are factored, and terms of like kind share their common
// factor.
#include "reading/layout.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <map>
#include <optional>

#include "reading/power_of_sum.hpp"
#include "reading/rational_function.hpp"

namespace eomgen::reading {
namespace {

// Lines break between terms, never inside a bracket: a bracket must fit on one line.
constexpr std::size_t longest_bracket = 6;

struct ByMotion {
  Monomial motion;  // velocities and accelerations
  Sum coefficient;  // everything else
};

bool moves(const Atom& atom) {
  if (atom.op != Op::symbol || atom.symbol.order == 0) return false;
  return atom.symbol.kind == SymbolKind::coordinate || atom.symbol.kind == SymbolKind::function;
}
bool is_fixed(const Atom& atom) {  // parameters and numbers: grouped last
  return atom.op == Op::pi || (atom.op == Op::symbol && (atom.symbol.kind == SymbolKind::parameter ||
                                                         atom.symbol.kind == SymbolKind::multiplier));
}

Formula factor_formula(const Factor& factor) {
  const Atom& atom = *factor.atom;
  const Rational exponent = cln::abs(factor.exponent);
  Formula base;
  switch (atom.op) {
    case Op::symbol: base = symbol(atom.symbol); break;
    case Op::pi: base.kind = FormulaKind::pi; break;
    case Op::add: base = arrange(atom.args[0]); break;
    case Op::pow:
      if (is_bracket(atom)) {
        base = bracket(atom.args[0]);
        base.keeps_sign = true;
      } else {
        base = make_formula(FormulaKind::power, {arrange(atom.args[0]), arrange(atom.args[1])});
      }
      break;
    default:
      base.kind = FormulaKind::call;
      base.op = atom.op;
      for (const Sum& arg : atom.args) base.args.push_back(arrange(arg, Layout::terms));
  }
  if (is_one(exponent)) return base;
  if (exponent == Rational(1) / 2) {
    Formula root = make_formula(FormulaKind::call, {std::move(base)});
    root.op = Op::sqrt;
    return root;
  }
  if (base.kind == FormulaKind::power) return make_formula(FormulaKind::power, {std::move(base), number(exponent)});
  return make_formula(FormulaKind::power, {std::move(base), number(exponent)});
}

std::vector<Formula> polynomial_terms(const Sum& sum);

bool has_negative_term(const Sum& sum) {
  return std::any_of(sum.terms().begin(), sum.terms().end(), [](const auto& term) { return cln::minusp(term.second); });
}

// -(a - b) as b - a.
Formula negated_bracket(const Sum& base) {
  std::vector<Formula> terms = polynomial_terms(-base);
  const auto positive =
      std::find_if(terms.begin(), terms.end(), [](const Formula& f) { return f.kind != FormulaKind::negative; });
  if (positive != terms.end()) std::rotate(terms.begin(), positive, positive + 1);
  return sum(std::move(terms));
}

Formula opposite(Formula f);

// a - b + c as b - a - c; the first added term leads.
Formula opposite_sum(Formula f) {
  for (Formula& term : f.args) term = opposite(std::move(term));
  const auto added =
      std::find_if(f.args.begin(), f.args.end(), [](const Formula& t) { return t.kind != FormulaKind::negative; });
  if (added != f.args.end()) std::rotate(f.args.begin(), added, added + 1);
  return f;
}

bool subtracts(const Formula& f) {
  return f.kind == FormulaKind::sum && !f.keeps_sign &&
         std::any_of(f.args.begin(), f.args.end(), [](const Formula& t) { return t.kind == FormulaKind::negative; });
}

// -f without a leading minus, if a bracket can absorb it: -(a - b) c is (b - a) c, also over a denominator.
Formula opposite(Formula f) {
  if (f.kind == FormulaKind::negative) return negative(std::move(f));
  if (subtracts(f)) return opposite_sum(std::move(f));
  if (f.kind == FormulaKind::product) {
    const auto found = std::find_if(f.args.begin(), f.args.end(), subtracts);
    if (found != f.args.end()) {
      *found = opposite_sum(std::move(*found));
      return f;
    }
  }
  if (f.kind == FormulaKind::fraction) {
    Formula above = opposite(f.args[0]);
    if (above.kind != FormulaKind::negative) {
      f.args[0] = std::move(above);
      return f;
    }
  }
  return negative(std::move(f));
}

}  // namespace

long degree(const Monomial& monomial) {
  Rational sum = 0;
  for (const Factor& factor : monomial) sum = sum + cln::abs(factor.exponent);
  return cln::cl_I_to_long(cln::ceiling1(sum));
}

Formula led_by_plus(Formula f, bool reordered) {
  if (f.kind == FormulaKind::negative) return opposite(std::move(f.args[0]));
  if (f.kind != FormulaKind::sum || f.args[0].kind != FormulaKind::negative) return f;
  f.args[0] = opposite(std::move(f.args[0].args[0]));
  if (!reordered || f.args[0].kind != FormulaKind::negative) return f;
  const auto added =
      std::find_if(f.args.begin(), f.args.end(), [](const Formula& t) { return t.kind != FormulaKind::negative; });
  if (added != f.args.end()) std::rotate(f.args.begin(), added, added + 1);
  return f;
}

namespace {

// The factor 1/(a - b) of a negative term, displayed as 1/(b - a) of a positive one.
const Factor* sign_absorbing_factor(const Monomial& monomial) {
  for (const Factor& factor : monomial) {
    if (factor.atom->op == Op::add && factor.exponent == -1 && has_negative_term(factor.atom->args[0])) return &factor;
  }
  return nullptr;
}

}  // namespace

Formula bracket(const Sum& rest) { return led_by_plus(sum(polynomial_terms(rest)), true); }

Formula term_formula(const Rational& coefficient, const Monomial& monomial, std::vector<Formula> brackets,
                     const Monomial& motion, bool brackets_first) {
  std::vector<Formula> above, below;
  const cln::cl_I top = cln::numerator(cln::abs(coefficient)), bottom = cln::denominator(coefficient);
  const auto add_brackets = [&] {
    for (Formula& f : brackets) above.push_back(std::move(f));
  };
  const Factor* const taker = cln::minusp(coefficient) ? sign_absorbing_factor(monomial) : nullptr;
  const auto add_factors = [&](const Monomial& factors) {
    for (const Factor& factor : factors) {
      Formula f = &factor == taker ? negated_bracket(factor.atom->args[0]) : factor_formula(factor);
      (cln::minusp(factor.exponent) ? below : above).push_back(std::move(f));
    }
  };
  if (brackets_first) add_brackets();
  add_factors(monomial);
  if (!brackets_first) add_brackets();
  add_factors(motion);
  Formula result;
  const bool of_pi = above.size() == 1 && above[0].kind == FormulaKind::pi;  // pi/2
  if (below.empty() && !of_pi) {
    above.insert(above.begin(), number(Rational(top) / bottom));
    result = product(std::move(above));
  } else {
    above.insert(above.begin(), number(top));
    below.insert(below.begin(), number(bottom));
    result = fraction(product(std::move(above)), product(std::move(below)));
  }
  return cln::minusp(coefficient) && taker == nullptr ? negative(std::move(result)) : result;
}

namespace {

// Splits a monomial into the factors that satisfy `pick` and the rest.
template <class Pick>
std::pair<Monomial, Monomial> split(const Monomial& monomial, Pick&& pick) {
  std::pair<Monomial, Monomial> result;
  for (const Factor& factor : monomial) (pick(*factor.atom) ? result.first : result.second).push_back(factor);
  return result;
}

template <class Pick>
std::vector<ByMotion> gather(const Sum& sum, Pick&& pick) {
  std::vector<ByMotion> groups;
  for (const auto& [monomial, coefficient] : display_order(sum)) {
    const auto [motion, rest] = split(monomial, pick);
    const auto same = [&m = motion](const ByMotion& g) { return compare(g.motion, m) == 0; };
    auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end()) found = groups.insert(groups.end(), {motion, Sum()});
    found->coefficient.add(rest, coefficient);
  }
  return groups;
}

/// A sum as content times the rest, with a sign that makes the first term positive.
struct Factored {
  Rational number = 1;
  Monomial monomial;
  Sum rest = 1;
};
Factored factor_out(const Sum& sum) {
  const Content common = content(sum);
  Factored result{common.number, common.monomial, divide(sum, common)};
  if (has_negative_leading_term(result.rest)) {
    result.rest = -result.rest;
    result.number = -result.number;
  }
  return result;
}

bool is_of_parameters(const Sum& sum) {
  bool result = true;
  for_each_atom(sum, [&](const Atom& atom) { result = result && is_fixed(atom); });
  return result;
}

Formula factored_formula(const Factored& f, const Monomial& motion = {}) {
  if (f.rest.is_number()) return term_formula(f.number, f.monomial, {}, motion);
  return term_formula(f.number, f.monomial, {bracket(f.rest)}, motion, is_of_parameters(f.rest));
}

// m1 l^2 + m2 l^2 + m2 k^2 -> (m1 + m2) l^2 + m2 k^2: extracts the factor that saves most, if any.
bool factor_out_best(Sum& left, Factored& taken) {
  if (left.size() < 2 || left.size() > 64) return false;
  long best = 0;
  Monomial factor;
  for (auto i = left.terms().begin(); i != left.terms().end(); ++i) {
    for (auto j = std::next(i); j != left.terms().end(); ++j) {
      Sum both(i->first, 1);
      both.add(j->first, 1);
      Monomial common = content(both).monomial;
      std::erase_if(common, [](const Factor& f) { return cln::minusp(f.exponent); });
      if (common.empty()) continue;
      long members = 0;
      for (const auto& [monomial, coefficient] : left.terms()) {
        Sum pair(monomial, 1);
        pair.add(common, 1);
        if (pair.size() == 1 || compare(content(pair).monomial, common) == 0) ++members;
      }
      const long saved = (members - 1) * degree(common) * 4 + degree(common);
      if (saved > best) {
        best = saved;
        factor = common;
      }
    }
  }
  if (factor.empty()) return false;
  Sum inside, outside;
  for (const auto& [monomial, coefficient] : left.terms()) {
    Sum pair(monomial, 1);
    pair.add(factor, 1);
    const bool member = pair.size() == 1 || compare(content(pair).monomial, factor) == 0;
    (member ? inside : outside).add(monomial, coefficient);
  }
  taken = factor_out(inside);
  left = std::move(outside);
  return true;
}

// Terms of a sum without velocities: grouped by their dependence on coordinates, each coefficient factored.
std::vector<Formula> polynomial_terms(const Sum& sum) {
  std::vector<Formula> result;
  for (const ByMotion& group : gather(sum, [](const Atom& atom) { return !is_fixed(atom); })) {
    Sum left = group.coefficient;
    const Factored whole = factor_out(left);
    if (left.size() == 1 || !whole.monomial.empty() || !group.motion.empty()) {
      Factored f = whole;
      const Sum both = multiply(f.monomial, group.motion);
      f.monomial = both.terms().begin()->first;
      result.push_back(factored_formula(f));
      continue;
    }
    Factored taken;
    while (factor_out_best(left, taken)) result.push_back(factored_formula(taken));
    for (const auto& [monomial, coefficient] : display_order(left))
      result.push_back(term_formula(coefficient, monomial));
  }
  return result;
}

// Velocities and accelerations in the order of a term's kind: accelerations, quadratic, linear, none.
std::pair<Rational, Rational> kind(const Monomial& motion) {
  std::pair<Rational, Rational> result{0, 0};
  for (const Factor& factor : motion)
    (factor.atom->symbol.order >= 2 ? result.first : result.second) += factor.exponent;
  return result;
}

// (u^2 + v^2) u_dot^2 + (u^2 + v^2) v_dot^2 -> (u^2 + v^2) (u_dot^2 + v_dot^2)
std::vector<Formula> share_brackets(const std::vector<ByMotion>& groups) {
  std::vector<Formula> result;
  std::vector<bool> done(groups.size(), false);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (done[i]) continue;
    const Factored f = factor_out(groups[i].coefficient);
    std::vector<Formula> motions{term_formula(1, groups[i].motion)};
    const bool worth_it = !groups[i].motion.empty() && (!f.rest.is_number() || !f.monomial.empty());
    for (std::size_t j = i + 1; j < groups.size() && worth_it; ++j) {
      if (done[j] || groups[j].motion.empty() || kind(groups[j].motion) != kind(groups[i].motion)) continue;
      const Factored g = factor_out(groups[j].coefficient);
      if (!(g.rest == f.rest) || compare(g.monomial, f.monomial) != 0 || g.number != f.number) continue;
      motions.push_back(term_formula(1, groups[j].motion));
      done[j] = true;
    }
    if (motions.size() == 1) {
      if (groups[i].motion.empty()) {
        for (Formula& term : polynomial_terms(groups[i].coefficient)) result.push_back(std::move(term));
      } else {
        result.push_back(factored_formula(f, groups[i].motion));
      }
      continue;
    }
    std::vector<Formula> brackets{sum(std::move(motions))};
    if (!f.rest.is_number()) brackets.insert(brackets.begin(), bracket(f.rest));
    result.push_back(term_formula(f.number, f.monomial, std::move(brackets)));
  }
  return result;
}

// (x^2 + y^2)/2 in place of x^2/2 + y^2/2, if that makes most terms simpler.
std::optional<Formula> number_in_front(const Sum& whole) {
  constexpr std::size_t longest = 9;  // a bracket cannot be broken over lines
  if (whole.size() < 3 || whole.size() > longest) return std::nullopt;
  const Rational number = content(whole).number;
  if (is_integer(number)) return std::nullopt;
  std::size_t simple = 0;
  for (const auto& [monomial, coefficient] : whole.terms()) {
    if (cln::abs(coefficient) == number) ++simple;
    for (const Factor& factor : monomial) {
      if (moves(*factor.atom) || is_bracket(*factor.atom)) return std::nullopt;
    }
  }
  if (3 * simple < 2 * whole.size()) return std::nullopt;
  const bool minus = has_negative_leading_term(whole);
  const Content front{minus ? -number : number, {}};
  return term_formula(front.number, {}, {sum(polynomial_terms(divide(whole, front)))});
}

/// Whether a coefficient is M_ik: of an acceleration, or of a rate in a momentum. M_ik leads one equation and not the
/// other; it is (m3 - m2) in both, not -(m2 - m3) in one.
bool is_entry_of_mass_matrix(const Monomial& motion, const std::vector<ByMotion>& all) {
  const auto is_single = [](const Monomial& m) { return m.size() == 1 && is_one(m[0].exponent); };
  if (!is_single(motion)) return false;
  if (motion[0].atom->symbol.order >= 2) return true;
  return std::all_of(all.begin(), all.end(), [&](const ByMotion& group) {
    return is_single(group.motion) && group.motion[0].atom->symbol.order == 1;
  });
}

}  // namespace

std::vector<Formula> arranged_terms(const Sum& whole, Layout layout) {
  const std::vector<ByMotion> groups = gather(whole, moves);
  if (layout == Layout::terms) {
    std::vector<Formula> result;
    for (const ByMotion& group : groups) {
      if (group.motion.empty()) {
        for (Formula& term : polynomial_terms(group.coefficient)) result.push_back(std::move(term));
      } else {
        const Factored f = factor_out(group.coefficient);
        Formula term = factored_formula(f, group.motion);
        const bool flips = term.kind == FormulaKind::negative && is_of_parameters(f.rest) &&
                           is_entry_of_mass_matrix(group.motion, groups);
        result.push_back(flips ? opposite(std::move(term.args[0])) : std::move(term));
      }
    }
    return result;
  }
  if (std::optional<Formula> halved = number_in_front(whole)) return {std::move(*halved)};
  std::vector<Formula> result;
  for (std::size_t first = 0; first < groups.size();) {
    std::size_t last = first;
    Sum together;  // only for its content
    while (last < groups.size() && kind(groups[last].motion) == kind(groups[first].motion)) {
      together += Sum(groups[last].motion, 1) * groups[last].coefficient;
      ++last;
    }
    const Factored f = factor_out(together);
    const bool motion_only =
        std::any_of(f.monomial.begin(), f.monomial.end(), [](const Factor& x) { return moves(*x.atom); });
    const bool shared = last - first > 1 && last - first <= longest_bracket && !f.monomial.empty() && !motion_only;
    const std::vector<ByMotion> part(groups.begin() + static_cast<std::ptrdiff_t>(first),
                                     groups.begin() + static_cast<std::ptrdiff_t>(last));
    if (shared) {
      result.push_back(term_formula(f.number, f.monomial, {sum(share_brackets(gather(f.rest, moves)))}));
    } else {
      for (Formula& term : share_brackets(part)) result.push_back(std::move(term));
    }
    first = last;
  }
  return result;
}

Formula arrange_by_factors(const Sum& whole) {
  std::vector<Formula> result;
  // Accelerations, rates and the rest stay apart.
  std::map<std::pair<long, long>, Sum> kinds;
  for (const auto& [monomial, coefficient] : whole.terms()) {
    long accelerations = 0, rates = 0;
    for (const Factor& factor : monomial) {
      if (!moves(*factor.atom)) continue;
      (factor.atom->symbol.order >= 2 ? accelerations : rates) += 1;
    }
    kinds[{-accelerations, -rates}].add(monomial, coefficient);
  }
  for (auto& [kind, left] : kinds) {
    Factored taken;
    while (factor_out_best(left, taken)) result.push_back(factored_formula(taken));
    for (const auto& [monomial, coefficient] : display_order(left))
      result.push_back(term_formula(coefficient, monomial));
  }
  return led_by_plus(sum(std::move(result)), true);
}

Formula factored(const Sum& whole) {
  if (whole.size() < 2) return arrange(whole, Layout::terms);
  const Factorisation parts = factorise(whole);
  std::vector<Formula> brackets;
  bool minus = parts.sign < 0;
  for (const auto& [base, times] : parts.factors) {
    const bool takes = minus && times % 2 != 0 && has_negative_term(base);
    Formula f = takes ? negated_bracket(base) : sum(polynomial_terms(base));
    minus = minus && !takes;
    brackets.push_back(times == 1 ? std::move(f) : make_formula(FormulaKind::power, {std::move(f), number(times)}));
  }
  return term_formula(minus ? -parts.content.number : parts.content.number, parts.content.monomial,
                      std::move(brackets));
}

Formula arrange(const Sum& whole, Layout layout) {
  return led_by_plus(sum(arranged_terms(whole, layout)), layout == Layout::grouped);
}

}  // namespace eomgen::reading
