// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/reading.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <unordered_map>

#include "mechanics/dependent_coordinates.hpp"
#include "reading/approaches.hpp"
#include "reading/constrained_roots.hpp"
#include "reading/forms.hpp"
#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/sum.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

// Sums that were converted from nodes of the Dag used last. Documents show the same generalised forces in several
// forms, and each conversion of a long force takes a fraction of a second.

/// Safe to use from several threads, which then may replace each other's Dag.
class SumMemo {
 public:
  std::optional<Sum> find(const std::shared_ptr<symbolic::Dag>& dag, symbolic::Ref expression) {
    const std::lock_guard lock(mutex_);
    if (!is_of(dag)) return std::nullopt;
    const auto found = sums_.find(expression);
    return found == sums_.end() ? std::nullopt : std::optional(found->second);
  }

  void store(const std::shared_ptr<symbolic::Dag>& dag, symbolic::Ref expression, const Sum& sum) {
    const std::lock_guard lock(mutex_);
    if (!is_of(dag)) {
      sums_.clear();
      dag_ = dag;
    }
    sums_.emplace(expression, sum);
  }

 private:
  // Owners are compared, since another Dag may get the address of one that no longer exists.
  bool is_of(const std::shared_ptr<symbolic::Dag>& dag) const {
    return !dag_.owner_before(dag) && !dag.owner_before(dag_);
  }

  std::mutex mutex_;
  std::weak_ptr<symbolic::Dag> dag_;
  std::map<symbolic::Ref, Sum> sums_;
};

// For equations that are too long to display: keeps the list of coordinates and forces only.
void leave_unexpanded(const Mechanics& m, DisplayForm& form, const std::string& why) {
  form.is_unexpanded = true;
  form.unexpanded_reason = why;
  form.kinetic = form.potential = form.lagrangian = form.translation = Sum();
  form.by_degree.reset();
  form.equations.clear();
  form.reactions.clear();
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    const bool of_motion = !m.is_eliminated(i);
    if (!of_motion && form.approach == system::Approach::two) continue;
    Equation equation;
    equation.coordinate = i;
    equation.of_motion = of_motion;
    form.equations.push_back(std::move(equation));
  }
}

/// The result of `read` within the budget of an item, or the reason if it takes more.
template <class Read>
std::string within_budget(Read&& read) {
  try {
    const work::Budget budget(item_budget);
    read();
    return "";
  } catch (const work::BudgetExceeded& over) {
    return over.what();
  }
}

/// The value of the coordinate that the constraint fixes, if any.
void read_value(const Mechanics& m, GinacBridge& bridge, DisplayConstraint& c, DisplayForm& form) {
  const auto fixes = [&c](const mechanics::FixedCoordinate& f) { return f.constraint == c.constraint; };
  const auto found = std::find_if(m.fixed.begin(), m.fixed.end(), fixes);
  if (found == m.fixed.end()) return;
  const std::string no_value_error = within_budget([&] {
    c.value = bridge.sum(found->value);
    c.value_rate = bridge.sum(found->rate);
    c.value_acceleration = bridge.sum(found->acceleration);
    c.fixes = *found;
  });
  if (no_value_error.empty()) return;
  c.rate_skip_reason = c.acceleration_skip_reason = no_value_error;
  if (!form.is_unexpanded) leave_unexpanded(m, form, no_value_error);
}

void read_rates(const Mechanics& m, GinacBridge& bridge, DisplayConstraint& c) {
  const std::uint32_t k = c.constraint;
  c.psi_skip_reason = within_budget([&] {
    if (c.holonomic) c.psi = bridge.sum(m.constraints[k].psi);
  });
  c.rate_skip_reason = c.psi_skip_reason;
  if (c.rate_skip_reason.empty()) {
    c.rate_skip_reason = within_budget([&] {
      c.rate = c.holonomic ? bridge.total_derivative(c.psi) : simplify(bridge.sum(m.velocity_form(m.constraints[k])));
    });
  }
  c.acceleration_skip_reason = c.rate_skip_reason;
  if (c.acceleration_skip_reason.empty())
    c.acceleration_skip_reason = within_budget([&] { c.acceleration = bridge.total_derivative(c.rate); });
}

void add_constraints(const Mechanics& m, GinacBridge& bridge, Extent extent, DisplayForm& form) {
  const work::Budget budget(form_budget);  // of all items together
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (!m.is_independent(k)) continue;
    DisplayConstraint c;
    c.constraint = k;
    c.label = m.constraints[k].label;
    c.holonomic = m.constraints[k].holonomic();
    if (extent == Extent::whole) read_rates(m, bridge, c);
    read_value(m, bridge, c, form);
    if (extent == Extent::whole || c.fixes) form.constraints.push_back(std::move(c));
  }
}

/// Writes powers of sums whose value a constraint gives. The derivatives have been taken, so that equations, forces and
/// rates may use it. Left out beyond the budget.
void write_constrained_roots(const Mechanics& m, DisplayForm& form) {
  const ConstrainedRoots shorter = constrained_roots(m);
  const auto shorten = [&](Sum& sum) { within_budget([&] { sum = shorter(sum); }); };
  for (Equation& equation : form.equations) {
    for (Sum* part : {&equation.slope, &equation.force, &equation.expanded}) shorten(*part);
    for (MultiplierTerm& term : equation.multipliers) shorten(term.slope);
  }
  for (DisplayReaction& reaction : form.reactions) {
    if (reaction.value) shorten(*reaction.value);
  }
  for (DisplayConstraint& c : form.constraints) {
    shorten(c.rate);
    shorten(c.acceleration);
  }
}

/// The brackets of springs. None beyond the budget.
void add_powers(const Mechanics& m, GinacBridge& bridge, DisplayForm& form) {
  if (form.is_unexpanded) return;
  within_budget([&] {
    form.powers = powers_of_sums(
        m, bridge, form.approach == system::Approach::two ? imposed_values(m, bridge) : std::map<Symbol, Sum>{});
  });
}

/// The rotations; in Approach II with the constraints imposed. Throws work::BudgetExceeded.
std::vector<DisplayRotation> add_rotations(const Mechanics& m, GinacBridge& bridge, DisplayForm& form) {
  std::vector<DisplayRotation> body_rotations;
  try {
    body_rotations = form.body_rotations = display_rotations(m, bridge);
    if (form.approach == system::Approach::two && !body_rotations.empty()) {
      const std::map<Symbol, Sum> values = imposed_values(m, bridge);
      for (DisplayRotation& spin : form.body_rotations) {
        for (Sum& w : spin.w) w = simplify(bridge.substitute(w, values));
      }
    }
  } catch (const work::BudgetExceeded& over) {  // e.g. a long chain of relative rotations
    form.body_rotations.clear();
    form.rotations_skip_reason = over.what();
    if (body_rotations.empty()) throw;
  }
  return body_rotations;
}

/// An upper bound of the number of terms of the expanded equations; trigonometric simplification gives fewer.
double most_terms(const symbolic::Dag& dag, symbolic::Ref expression) {
  std::unordered_map<std::uint32_t, double> count;
  for (const symbolic::Ref r : dag.reachable({expression})) {
    const symbolic::Node& node = dag[r];
    const auto of = [&](std::size_t i) { return count.at(node.args[i].id); };
    double terms = 1;
    if (node.op == symbolic::Op::add || node.op == symbolic::Op::sub) terms = of(0) + of(1);
    if (node.op == symbolic::Op::mul) terms = of(0) * of(1);
    if (node.op == symbolic::Op::neg || node.op == symbolic::Op::div) terms = of(0);
    if (node.op == symbolic::Op::power) terms = std::pow(of(0), node.payload);
    count.emplace(r.id, terms);
  }
  return count.at(expression.id);
}

}  // namespace

DisplayForm derive_display_form(const Mechanics& given, system::Approach approach, Extent extent) try {
  const Mechanics m = approach == system::Approach::two ? mechanics::eliminate_dependent_coordinates(given) : given;
  DisplayForm form;
  form.approach = approach;
  GinacBridge bridge(m);
  // A result that would be too long is not started: along chains of relative rotations its length grows exponentially.
  constexpr double longest = 12000, longest_of_spins = 200000;
  const bool grows = !m.body_rotations.empty() || !m.dag->is_zero(m.kinetic_given);
  const double terms = grows ? most_terms(*m.dag, m.kinetic) : 0;
  try {
    const work::Budget budget(form_budget);  // one budget for the whole form
    if (terms > longest_of_spins) form.rotations_skip_reason = TermBudget().what();
    const std::vector<DisplayRotation> body_rotations =
        form.rotations_skip_reason.empty() ? add_rotations(m, bridge, form) : std::vector<DisplayRotation>{};
    if (terms > longest) throw TermBudget();
    if (approach == system::Approach::one)
      derive_approach_one(m, bridge, body_rotations, form);
    else
      derive_approach_two(m, bridge, body_rotations, form);
  } catch (const work::BudgetExceeded& over) {
    leave_unexpanded(m, form, over.what());
  }
  if (extent == Extent::whole || !form.is_unexpanded) add_constraints(m, bridge, extent, form);
  write_constrained_roots(m, form);
  add_powers(m, bridge, form);
  return form;
} catch (const std::domain_error&) {
  throw no_value_error(given);
}

std::vector<symbolic::Ref> residuals_on_dag(const DisplayForm& form, mechanics::Mechanics& m) {
  std::vector<symbolic::Ref> result;
  if (form.is_unexpanded) return result;
  symbolic::Dag& dag = *m.dag;
  for (const Equation& equation : form.equations) {
    if (!equation.of_motion) continue;
    symbolic::Ref residual = to_dag(dag, equation.expanded - equation.force);
    for (const MultiplierTerm& term : equation.multipliers) {
      const symbolic::Ref lambda = dag.symbol({SymbolKind::multiplier, term.constraint, 0});
      residual = dag.sub(residual, dag.mul(lambda, to_dag(dag, term.slope)));
    }
    result.push_back(residual);
  }
  for (const DisplayConstraint& c :
       form.constraints) {  // coordinates that Approach II expressed by others have moved accordingly
    if (!c.fixes || m.is_eliminated(c.fixes->coordinate)) continue;
    result.push_back(dag.sub(m.qddot[c.fixes->coordinate], to_dag(dag, c.value_acceleration)));
  }
  return result;
}

Sum display_sum(const Mechanics& m, symbolic::Ref expression) try {
  static SumMemo memo;
  if (const std::optional<Sum> known = memo.find(m.dag, expression)) return *known;
  const work::Budget budget(item_budget);
  GinacBridge bridge(m);
  const Sum sum = bridge.sum(expression);
  memo.store(m.dag, expression, sum);
  return sum;
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

DisplayForm::DisplayForm() = default;
DisplayForm::DisplayForm(const DisplayForm&) = default;
DisplayForm::DisplayForm(DisplayForm&&) noexcept = default;
DisplayForm& DisplayForm::operator=(const DisplayForm&) = default;
DisplayForm& DisplayForm::operator=(DisplayForm&&) noexcept = default;
DisplayForm::~DisplayForm() = default;

}  // namespace eomgen::reading
