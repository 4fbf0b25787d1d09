// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/state_comparisons.hpp"

#include <cln/real.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "derive/imposition.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::verify {

using symbolic::Ref;
using system::EquationSystem;

void top_level_terms(const symbolic::Dag& dag, Ref r, std::vector<Ref>& terms) {
  std::vector<Ref> open{r};
  while (!open.empty()) {
    const symbolic::Node& node = dag[open.back()];
    const Ref here = open.back();
    open.pop_back();
    switch (node.op) {
      case symbolic::Op::add:
      case symbolic::Op::sub:
      case symbolic::Op::neg:
        for (std::size_t i = 0; i < node.arity; ++i) open.push_back(node.args[i]);
        break;
      default: terms.push_back(here);
    }
  }
}

void compare_states(const mechanics::Mechanics& mechanics, const EquationSystem& s, const SystemValues& v,
                    const Oracle& oracle, ComparisonTable& tally) {
  const model::Model& m = oracle.model();
  if (m.states.empty()) return;
  const SymbolValues lookup(oracle, v.state);
  symbolic::Substitution written = derive::time_function_substitution(mechanics);
  const Interpreter now = oracle.interpreter(v.state);
  double of_integrals = 0, of_rates = 0;
  for (std::uint32_t i = 0; i < m.states.size(); ++i) {
    if (!m.states[i].integral) continue;
    const Ref form = written(mechanics.dag->symbol({symbolic::SymbolKind::integral, i, 0}));
    const Real value = symbolic::evaluate(*mechanics.dag, {form}, lookup, oracle.digits())[0];
    const Real span = v.state.t - v.state.parameters[*m.start_time];
    const Real scale = cln::abs(span * now.environment().states[i][1].real());
    of_integrals = std::max(of_integrals, relative_difference(value - v.state.z[i], cln::abs(v.state.z[i]) + scale));
  }
  for (const system::FirstOrderState& state : s.states) {
    std::vector<Ref> roots{state.rate};
    top_level_terms(*s.dag, state.rate, roots);
    const std::vector<Real> value = symbolic::evaluate(*s.dag, roots, lookup, oracle.digits());
    Real scale = 0;  // a rate may be 0 because its terms cancel
    for (std::size_t k = 1; k < value.size(); ++k) scale = scale + cln::abs(value[k]);
    double& largest = m.states[state.symbol.index].integral ? of_integrals : of_rates;
    largest = std::max(largest,
                       relative_difference(value[0] - now.environment().states[state.symbol.index][1].real(), scale));
  }
  const auto has = [&](bool integral) {
    return std::any_of(m.states.begin(), m.states.end(),
                       [=](const model::State& state) { return state.integral == integral; });
  };
  if (has(true)) tally.record("integrals of time", oracle_name, false, of_integrals);
  if (has(false)) tally.record("rates of states of first order", oracle_name, false, of_rates);
}

void compare_resets(const EquationSystem& s, const SystemValues& v, const Oracle& oracle, ComparisonTable& tally) {
  const model::Model& m = oracle.model();
  const SymbolValues lookup(oracle, v.state);
  double of_events = 0, of_resets = 0;
  const auto compare = [&](Ref form, model::NodeId written, double& largest) {
    std::vector<Ref> roots{form};
    top_level_terms(*s.dag, form, roots);
    // A value need not exist at every state, but then neither side has it.
    const auto value_of = [](const auto& evaluate) -> std::optional<std::vector<Real>> {
      try {
        return evaluate();
      } catch (const std::domain_error&) {
        return std::nullopt;
      }
    };
    const auto value = value_of([&] { return symbolic::evaluate(*s.dag, roots, lookup, oracle.digits()); });
    const auto expected = value_of([&] { return std::vector<Real>{oracle.evaluate(written, v.state)}; });
    if (value.has_value() != expected.has_value()) largest = 1;
    if (!value || !expected) return;
    Real scale = 0;
    for (std::size_t k = 1; k < value->size(); ++k) scale = scale + cln::abs((*value)[k]);
    largest = std::max(largest, relative_difference((*value)[0] - (*expected)[0], scale));
  };
  const auto place = [&](const model::Assignment& assignment) {
    using Target = model::Assignment::Target;
    const eom::StateLayout layout = s.layout();
    if (assignment.target == Target::state) {
      const auto found = std::find_if(s.states.begin(), s.states.end(),
                                      [&](const auto& z) { return z.symbol.index == assignment.index; });
      return layout.first_order_begin() + static_cast<std::size_t>(found - s.states.begin());
    }
    const auto found = std::find(s.free.begin(), s.free.end(), assignment.index);
    return static_cast<std::size_t>(found - s.free.begin()) +
           (assignment.target == Target::velocity ? layout.rates_begin() : 0);
  };
  // Accelerations and multipliers in an event function are those of the system, and not known to the oracle here.
  const auto is_of_state = [&](Ref form) {
    const std::vector<symbolic::Symbol> symbols = s.dag->symbols({form});
    return std::all_of(symbols.begin(), symbols.end(), [](const symbolic::Symbol& symbol) {
      using Kind = symbolic::SymbolKind;
      return symbol.kind == Kind::time || symbol.kind == Kind::parameter || symbol.kind == Kind::input ||
             symbol.kind == Kind::state || (symbol.kind == Kind::coordinate && symbol.order < 2);
    });
  };
  bool resets = false, events = false;
  const auto compare_reset = [&](const system::Reset& reset, const model::Reset& written) {
    if (reset.condition.has_value() != (written.condition != model::no_node) || reset.set.size() != written.set.size())
      of_resets = 1;
    if (of_resets == 1) return;
    resets = resets || !written.set.empty();
    if (reset.condition) compare(*reset.condition, written.condition, of_resets);
    for (const model::Assignment& assignment : written.set) {
      const auto entry = std::find_if(reset.set.begin(), reset.set.end(),
                                      [&](const auto& e) { return e.component == place(assignment); });
      if (entry == reset.set.end())
        of_resets = 1;
      else
        compare(entry->value, assignment.value, of_resets);
    }
  };
  if (s.events.size() != m.events.size() || s.samples.size() != m.samples.size()) of_resets = 1;
  for (std::size_t i = 0; of_resets < 1 && i < m.events.size(); ++i) {
    if (is_of_state(s.events[i].value)) {
      events = true;
      compare(s.events[i].value, m.events[i].when, of_events);
    }
    compare_reset(s.events[i].reset, m.events[i].reset);
  }
  for (std::size_t i = 0; of_resets < 1 && i < m.samples.size(); ++i)
    compare_reset(s.samples[i].reset, m.samples[i].reset);
  if (events) tally.record("events", oracle_name, false, of_events);
  if (resets || of_resets == 1) tally.record("resets", oracle_name, false, of_resets);
}

}  // namespace eomgen::verify
