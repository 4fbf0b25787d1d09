// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/solved_form.hpp"

#include <algorithm>
#include <stdexcept>

#include "lists.hpp"
#include "mechanics/dependent_coordinates.hpp"
#include "reading/lagrangian.hpp"
#include "reading/linear_system.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

constexpr std::uint8_t start_order = 4;  // of auxiliary symbols; 3 is that of momenta

bool can_stick(const mechanics::Contact& contact) { return contact.dimensions() > 0 && !contact.width; }

/// Sums of squares that a constraint gives: x^2 + y^2 = L^2 replaces them in roots and denominators.
struct Relation {
  std::uint32_t constraint = 0;
  Sum base, value;
};

class Solver {
 public:
  Solver(const Mechanics& m, const DisplayForm& one, FrictionMode mode)
      : m_(m),
        reduced_(mechanics::eliminate_dependent_coordinates(m)),
        bridge_(m),
        one_(one),
        values_(imposed_values(reduced_, bridge_)) {
    form_.mode = mode;
    // Contacts whose forces are inputs of the code are closed here too, unless they are more than could be.
    std::vector<std::uint32_t> closed;
    for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
      if (m.constraints[k].force_input && m.is_independent(k)) closed.push_back(k);
    }
    if (reduced_.active.size() + closed.size() > reduced_.free.size()) closed.clear();
    reduced_.active.insert(reduced_.active.end(), closed.begin(), closed.end());
    std::sort(reduced_.active.begin(), reduced_.active.end());
  }

  SolvedForm solve() {
    impose_closed_contacts();
    if (form_.mode == FrictionMode::holding) hold_rates();
    find_relations();
    add_equations();
    add_constraints();
    if (form_.mode == FrictionMode::holding) add_contacts();
    std::vector<Symbol> unknowns = mapped(reduced_.free, [&](std::uint32_t i) { return coordinate_symbol(i, 2); });
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (m_.is_independent(k)) unknowns.push_back({SymbolKind::multiplier, k, 0});
    }
    if (form_.mode == FrictionMode::holding) {
      for (const mechanics::Contact& contact : m_.contacts) {
        for (std::uint32_t a = 0; can_stick(contact) && a < contact.dimensions(); ++a)
          unknowns.push_back({SymbolKind::friction, contact.first + a, 0});
      }
    }
    std::vector<std::optional<Sum>> solution = solve_linear(equations_, unknowns);
    form_.multipliers.resize(m_.constraints.size());
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      if (!solution[j]) {
        form_.has_undetermined = true;
        continue;
      }
      Sum value = related(*std::move(solution[j]));
      const Symbol& symbol = unknowns[j];
      if (symbol.kind == SymbolKind::coordinate) {
        form_.accelerations.push_back({symbol.index, std::move(value)});
      } else if (symbol.kind == SymbolKind::multiplier) {
        form_.multipliers[symbol.index] = std::move(value);
      } else {
        if (form_.friction.size() <= symbol.index) form_.friction.resize(symbol.index + 1);
        form_.friction[symbol.index] = std::move(value);
      }
    }
    if (form_.mode == FrictionMode::given) find_closed_forms();
    add_dependent_accelerations();
    add_powers();
    return std::move(form_);
  }

 private:
  /// The expression with all constraints that give a coordinate imposed.
  Sum imposed(const Sum& sum) {
    Sum result = values_.empty() ? sum : bridge_.substitute(sum, values_);
    return held_.empty() ? result : bridge_.substitute(result, held_);
  }
  void add_powers() {
    std::map<Symbol, Sum> all = values_;
    all.insert(held_.begin(), held_.end());
    try {
      form_.powers = powers_of_sums(m_, bridge_, all);
    } catch (const work::BudgetExceeded&) {
    }
  }
  Sum multiplier(std::uint32_t k) { return bridge_.atom_table()({SymbolKind::multiplier, k, 0}); }

  void add_equations() {
    for (const Equation& equation : one_.equations) {
      Sum left = imposed(equation.expanded - equation.force);
      for (const MultiplierTerm& term : equation.multipliers) left -= multiplier(term.constraint) * imposed(term.slope);
      equations_.push_back(simplify(left));
    }
  }

  // A closed contact such as R - R0 = 0 gives its coordinate, as a constraint that always holds would.
  void impose_closed_contacts() {
    const std::vector<std::uint32_t> active = reduced_.active;
    for (const std::uint32_t k : active) {
      if (!m_.constraints[k].holonomic()) continue;
      const Sum psi = imposed(bridge_.sum(m_.constraints[k].psi));
      for (const std::uint32_t i : reduced_.free) {
        const Sum slope = bridge_.derivative(psi, coordinate_symbol(i, 0));
        if (!slope.is_number() || slope.is_zero()) continue;
        const Sum rest = psi - slope * bridge_.atom_table()(coordinate_symbol(i, 0));
        bool moves = false;
        for_each_atom(rest, [&](const Atom& atom) {
          moves = moves || (atom.op == Op::symbol && atom.symbol.kind == SymbolKind::coordinate);
        });
        if (moves) continue;
        const Sum value = (Rational(-1) / slope.number()) * rest, rate = bridge_.total_derivative(value);
        const std::map<Symbol, Sum> added{{coordinate_symbol(i, 0), value},
                                          {coordinate_symbol(i, 1), rate},
                                          {coordinate_symbol(i, 2), bridge_.total_derivative(rate)}};
        for (auto& [symbol, earlier] : values_) earlier = bridge_.substitute(earlier, added);
        values_.insert(added.begin(), added.end());
        std::erase(reduced_.free, i);
        std::erase(reduced_.active, k);
        break;
      }
    }
  }

  // Constraints that still have multipliers: their second derivatives determine accelerations.
  void add_constraints() {
    for (const DisplayConstraint& c : one_.constraints) {
      if (std::find(reduced_.active.begin(), reduced_.active.end(), c.constraint) == reduced_.active.end()) continue;
      const auto relation = std::find_if(relations_.begin(), relations_.end(),
                                         [&](const Relation& r) { return r.constraint == c.constraint; });
      if (relation != relations_.end()) {
        // Of x^2 + y^2 - L^2 the derivatives are shorter than those of its root, whose own rate is in them.
        const Sum rate = bridge_.total_derivative(relation->base - relation->value);
        equations_.push_back(simplify(imposed(bridge_.total_derivative(rate))));
        continue;
      }
      if (!c.acceleration_skip_reason.empty()) throw work::BudgetExceeded(c.acceleration_skip_reason);
      equations_.push_back(simplify(imposed(c.acceleration)));
    }
  }

  // The slip of a contact that holds stays 0.
  void add_contacts() {
    for (const mechanics::Contact& contact : m_.contacts) {
      if (!can_stick(contact)) continue;
      if (!contact.blocked.empty())
        throw work::BudgetExceeded(
            "a stop or another constraint holds the contact too: its friction is not determined");
      for (const symbolic::Ref slip : contact.slip)
        equations_.push_back(simplify(imposed(bridge_.total_derivative(bridge_.sum(slip)))));
    }
  }

  // Rates that follow from slip = 0 and the constraints, if all of them do.
  void hold_rates() {
    std::vector<Sum> slips;
    for (const DisplayConstraint& c : one_.constraints) {
      if (std::find(reduced_.active.begin(), reduced_.active.end(), c.constraint) != reduced_.active.end() &&
          c.rate_skip_reason.empty())
        slips.push_back(imposed(c.rate));
    }
    for (const mechanics::Contact& contact : m_.contacts) {
      if (!can_stick(contact)) continue;
      for (const symbolic::Ref slip : contact.slip) slips.push_back(imposed(bridge_.sum(slip)));
    }
    std::vector<Symbol> rates = mapped(reduced_.free, [&](std::uint32_t i) { return coordinate_symbol(i, 1); });
    if (rates.size() != slips.size()) return;
    const std::vector<std::optional<Sum>> solution = solve_linear(slips, rates);
    for (std::size_t j = 0; j < rates.size(); ++j) {
      if (!solution[j]) return held_.clear();
      held_[rates[j]] = *solution[j];
    }
  }

  // psi = c (B - v) with a sum B of coordinates that some root or denominator contains, and v of parameters.
  void find_relations() {
    for (const std::uint32_t k : reduced_.active) {
      if (!m_.constraints[k].holonomic()) continue;
      const Sum psi = imposed(bridge_.sum(m_.constraints[k].psi));
      Sum moving, rest;
      for (const auto& [monomial, coefficient] : psi.terms()) {
        bool moves = false;
        for (const Factor& factor : monomial)
          for_each_atom(factor, [&](const Atom& atom) {
            moves = moves || (atom.op == Op::symbol && atom.symbol.kind == SymbolKind::coordinate);
          });
        (moves ? moving : rest).add(monomial, coefficient);
      }
      if (moving.is_zero() || rest.is_zero()) continue;
      // sqrt(B) = v: B = v^2.
      if (moving.size() == 1) {
        const auto& [monomial, coefficient] = *moving.terms().begin();
        if (monomial.size() != 1 || monomial[0].atom->op != Op::add || monomial[0].exponent != Rational(1) / 2)
          continue;
        const Sum root = -(Rational(1) / coefficient) * rest;
        relations_.push_back({k, monomial[0].atom->args[0], root * root});
        continue;
      }
      const Content common = content(moving);
      if (!common.monomial.empty()) continue;
      const Rational scale = has_negative_leading_term(moving) ? -common.number : common.number;
      relations_.push_back({k, divide(moving, {scale, {}}), divide(-rest, {scale, {}})});
    }
  }

  Sum related(Sum sum) {
    for (const Relation& relation : relations_) {
      Sum result;
      for (const auto& [monomial, coefficient] : sum.terms()) {
        Sum term(coefficient);
        for (const Factor& factor : monomial) {
          const bool is_base = factor.atom->op == Op::add && factor.atom->args[0] == relation.base;
          term = term * (is_base ? power(relation.value, factor.exponent) : Sum(Monomial{factor}, 1));
        }
        result += term;
      }
      sum = simplify(without(relation, simplify(cancel(result))));
    }
    return sum;
  }

  /// The sum with the relation used in its numerator too, where that makes it shorter: x^2 + y^2 is L^2.
  static Sum without(const Relation& relation, const Sum& sum) {
    Sum best = sum;
    for (const auto& [lead, coefficient] : relation.base.terms()) {
      const Sum value = Rational(1) / coefficient * (relation.value - (relation.base - Sum(lead, coefficient)));
      Sum result;
      for (const auto& [monomial, factor] : sum.terms()) {
        const Sum over = multiply(monomial, inverse(lead));
        const bool divides = over.size() == 1 && is_divisor(lead, monomial);
        result += divides ? factor * (over * value) : Sum(monomial, factor);
      }
      result = simplify(result);
      if (result.size() < best.size()) best = std::move(result);
    }
    return best;
  }
  static bool is_divisor(const Monomial& divisor, const Monomial& of) {
    return std::all_of(divisor.begin(), divisor.end(), [&](const Factor& f) {
      return std::any_of(of.begin(), of.end(),
                         [&](const Factor& g) { return compare(*f.atom, *g.atom) == 0 && f.exponent <= g.exponent; });
    });
  }

  // Of coordinates that constraints give in terms of others, which move with them.
  void add_dependent_accelerations() {
    std::map<Symbol, Sum> solved;
    for (const SolvedAcceleration& a : form_.accelerations) solved[coordinate_symbol(a.coordinate, 2)] = a.value;
    if (solved.size() != reduced_.free.size()) return;
    for (const auto& [symbol, value] : values_) {
      if (symbol.order != 2 || m_.is_eliminated(symbol.index)) continue;
      form_.accelerations.push_back({symbol.index, related(simplify(cancel(bridge_.substitute(value, solved))))});
    }
    std::sort(form_.accelerations.begin(), form_.accelerations.end(),
              [](const SolvedAcceleration& a, const SolvedAcceleration& b) { return a.coordinate < b.coordinate; });
  }

  // qddot = a: a parabola. qddot = a - k q with k > 0: an oscillation about a/k.
  void find_closed_forms() {
    for (const SolvedAcceleration& acceleration : form_.accelerations) {
      const std::uint32_t i = acceleration.coordinate;
      const Symbol q = coordinate_symbol(i, 0);
      Sum constant, stiffness;
      bool fits = true;
      for (const auto& [monomial, coefficient] : acceleration.value.terms()) {
        Monomial others;
        bool of_q = false;
        for (const Factor& factor : monomial) {
          if (factor.atom->op == Op::symbol && factor.atom->symbol == q && is_one(factor.exponent)) {
            of_q = true;
            continue;
          }
          for_each_atom(factor, [&](const Atom& atom) {
            fits = fits && (atom.op != Op::symbol || atom.symbol.kind == SymbolKind::parameter);
          });
          others.push_back(factor);
        }
        (of_q ? stiffness : constant).add(others, of_q ? -coefficient : coefficient);
      }
      if (!fits) continue;
      const Sum q0 = bridge_.atom_table()(initial_symbol(i, 0)), v0 = bridge_.atom_table()(initial_symbol(i, 1));
      const Sum t = bridge_.atom_table()({SymbolKind::time, 0, 0});
      if (stiffness.is_zero()) {
        form_.closed.push_back({i, q0 + v0 * t + Rational(1) / 2 * (constant * t * t)});
      } else if (is_positive(stiffness)) {
        const Sum rest = simplify(quotient(constant, stiffness)), w = power(stiffness, Rational(1) / 2);
        form_.closed.push_back({i, rest + (q0 - rest) * call(Op::cos, {w * t}) +
                                       v0 * power(stiffness, Rational(-1) / 2) * call(Op::sin, {w * t})});
      }
    }
  }
  /// Whether all terms are products of positive parameters with positive coefficients.
  static bool is_positive(const Sum& sum) {
    return std::all_of(sum.terms().begin(), sum.terms().end(), [](const auto& term) {
      return cln::plusp(term.second) &&
             std::all_of(term.first.begin(), term.first.end(), [](const Factor& f) { return f.atom->positive; });
    });
  }

  const Mechanics& m_;
  Mechanics reduced_;
  GinacBridge bridge_;
  const DisplayForm& one_;
  std::map<Symbol, Sum> values_, held_;
  std::vector<Sum> equations_;
  std::vector<Relation> relations_;
  SolvedForm form_;
};

}  // namespace

Symbol initial_symbol(std::uint32_t coordinate, std::uint8_t order) {
  return {SymbolKind::auxiliary, coordinate, static_cast<std::uint8_t>(start_order + order)};
}

std::vector<symbolic::Ref> residuals_on_dag(const SolvedForm& form, Mechanics& m) {
  std::vector<symbolic::Ref> result;
  symbolic::Dag& dag = *m.dag;
  for (const SolvedAcceleration& a : form.accelerations)
    result.push_back(dag.sub(m.qddot[a.coordinate], to_dag(dag, a.value)));
  for (std::uint32_t k = 0; k < form.multipliers.size(); ++k) {
    if (form.multipliers[k])
      result.push_back(dag.sub(dag.symbol({SymbolKind::multiplier, k, 0}), to_dag(dag, *form.multipliers[k])));
  }
  return result;
}

bool can_hold(const Mechanics& m) { return std::any_of(m.contacts.begin(), m.contacts.end(), can_stick); }

SolvedForm solved_form(const Mechanics& mechanics, const DisplayForm& one, FrictionMode mode) try {
  SolvedForm form;
  if (one.is_unexpanded) {
    form.skip_reason = one.unexpanded_reason;
    return form;
  }
  try {
    const work::Budget budget(form_budget);
    return Solver(mechanics, one, mode).solve();
  } catch (const work::BudgetExceeded& over) {
    form.skip_reason = over.what();
  }
  return form;
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

}  // namespace eomgen::reading
