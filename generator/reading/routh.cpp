// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/routh.hpp"

#include <algorithm>
#include <stdexcept>

#include "reading/approaches.hpp"
#include "reading/forms.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/small_matrix.hpp"
#include "reading/trig.hpp"
#include "reading/zero_test.hpp"

namespace eomgen::reading {
namespace {

bool is_in(const std::vector<std::uint32_t>& list, std::uint32_t i) {
  return std::find(list.begin(), list.end(), i) != list.end();
}

// Solves the momenta of the cyclic coordinates for their rates. False if they are not linear in the rates or do not
// determine them.
bool solve_rates(GinacBridge& bridge, RouthForm& form) {
  const std::size_t n = form.cyclic.size();
  std::map<Symbol, Sum> at_rest;
  for (const std::uint32_t c : form.cyclic) at_rest[coordinate_symbol(c, 1)] = Sum();
  std::vector<Sum> inertia, right;
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::uint32_t c : form.cyclic)
      inertia.push_back(simplify(bridge.derivative(form.momenta[i], coordinate_symbol(c, 1))));
    right.push_back(Sum(bridge.atom_table().atom(momentum_symbol(form.cyclic[i]))) -
                    bridge.substitute(form.momenta[i], at_rest));
  }
  for (const Sum& entry : inertia) {
    for (const std::uint32_t c : form.cyclic) {
      if (contains(entry, coordinate_symbol(c, 1))) return false;
    }
  }
  if (zero_test(determinant(inertia, n)) != ZeroTestResult::no) return false;
  const std::vector<Sum> inverse = inverse_matrix(inertia, n);
  for (std::size_t i = 0; i < n; ++i) {
    Sum rate;
    for (std::size_t k = 0; k < n; ++k) rate += inverse[i * n + k] * right[k];
    form.rates.push_back(simplify(cancel(rate)));
  }
  return true;
}

/// The constrained Lagrangian: that of the form, unless the form imposes more constraints than those that fix
/// coordinates.
Sum lagrangian(const Mechanics& m, GinacBridge& bridge, const DisplayForm& two) {
  if (two.equations.size() == m.free.size()) {
    if (two.is_unexpanded) throw work::BudgetExceeded(two.unexpanded_reason);
    return two.lagrangian;
  }
  DisplayForm whole;
  whole.approach = system::Approach::two;
  derive_approach_two(m, bridge, display_rotations(m, bridge), whole);
  return std::move(whole.lagrangian);
}

void reduce(const Mechanics& m, GinacBridge& bridge, const DisplayForm& two, RouthForm& form) {
  const Sum L = lagrangian(m, bridge, two);
  for (const std::uint32_t c : form.cyclic) {
    form.momenta.push_back(simplify(bridge.derivative(L, coordinate_symbol(c, 1))));
  }
  if (!solve_rates(bridge, form)) {
    form.is_unexpanded = true;
    return;
  }
  std::map<Symbol, Sum> values = imposed_values(m, bridge), rates;
  for (std::size_t i = 0; i < form.cyclic.size(); ++i) rates[coordinate_symbol(form.cyclic[i], 1)] = form.rates[i];
  form.routhian = bridge.substitute(L, rates);
  for (std::size_t i = 0; i < form.cyclic.size(); ++i) {
    form.routhian -= Sum(bridge.atom_table().atom(momentum_symbol(form.cyclic[i]))) * form.rates[i];
  }
  form.routhian = simplify(cancel(form.routhian));
  values.insert(rates.begin(), rates.end());  // forces may depend on the eliminated rates
  Sum energy = -form.routhian;
  for (const std::uint32_t i : m.free) {
    if (is_in(form.cyclic, i)) continue;
    form.equations.push_back(lagrange_equation(m, bridge, form.routhian, i, values));
    energy += Sum(bridge.atom_table().atom(coordinate_symbol(i, 1))) * form.equations.back().momentum;
  }
  if (bridge.explicit_derivative(form.routhian).is_zero()) form.energy = simplify(cancel(energy));
}

}  // namespace

Symbol momentum_symbol(std::uint32_t coordinate) { return {SymbolKind::auxiliary, coordinate, 3}; }

RouthForm routh_form(const Mechanics& m, const std::vector<std::uint32_t>& cyclic, const DisplayForm& two) try {
  RouthForm form;
  form.cyclic = cyclic;
  GinacBridge bridge(m);
  try {
    const work::Budget budget(form_budget);
    reduce(m, bridge, two, form);
  } catch (const work::BudgetExceeded&) {
    form.is_unexpanded = true;
  }
  form.powers = two.powers;
  if (form.is_unexpanded) form = RouthForm{true, cyclic, {}, {}, {}, {}, {}, {}};
  return form;
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

std::vector<symbolic::Ref> residuals_on_dag(const RouthForm& form, Mechanics& m) {
  std::vector<symbolic::Ref> result;
  if (form.is_unexpanded || form.cyclic.empty()) return result;
  symbolic::Dag& dag = *m.dag;
  symbolic::Derivation ddt = symbolic::total_time_derivative(dag, m.q.size(), m.model->functions.size());
  std::map<Symbol, symbolic::Ref> momenta;
  for (std::size_t i = 0; i < form.cyclic.size(); ++i) {
    const symbolic::Ref p = to_dag(dag, form.momenta[i]);
    momenta[momentum_symbol(form.cyclic[i])] = p;
    result.push_back(ddt(p));
  }
  symbolic::Substitution written(dag, momenta);
  DisplayForm reduced;
  reduced.equations = form.equations;
  for (const symbolic::Ref r : residuals_on_dag(reduced, m)) result.push_back(written(r));
  return result;
}

}  // namespace eomgen::reading
