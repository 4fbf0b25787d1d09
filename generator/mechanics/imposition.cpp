// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/imposition.hpp"

#include <algorithm>

#include "symbolic/definite_integral.hpp"

namespace eomgen::mechanics {
namespace {

constexpr std::uint8_t highest_order = 6;

}  // namespace

symbolic::Substitution constraint_substitution(const Mechanics& m) {
  std::map<Symbol, Ref> values;
  for (const FixedCoordinate& fixed : m.fixed) {
    values[{SymbolKind::coordinate, fixed.coordinate, 0}] = fixed.value;
    values[{SymbolKind::coordinate, fixed.coordinate, 1}] = fixed.rate;
    values[{SymbolKind::coordinate, fixed.coordinate, 2}] = fixed.acceleration;
  }
  return {*m.dag, std::move(values)};
}

namespace {

using Values = std::map<Symbol, Ref>;

Values with_derivatives(Dag& dag, const std::vector<Ref>& value) {
  Values values;
  symbolic::Derivation ddt = symbolic::total_time_derivative(dag, 0, value.size());
  for (std::uint32_t i = 0; i < value.size(); ++i) {
    Ref derivative = value[i];
    for (std::uint8_t order = 0; order <= highest_order; ++order) {
      values[{SymbolKind::function, i, order}] = derivative;
      derivative = ddt(derivative);
    }
  }
  return values;
}

struct Integrand {
  std::uint32_t integral;
  Ref rate;
};

// All functions of time and their derivatives, as expressions of t, parameters and integrals; the integrands likewise.
Values written_functions(const Mechanics& m, std::vector<Integrand>& integrands) {
  Dag& dag = *m.dag;
  // Functions may use one another, without cycles: n rounds resolve the longest chain.
  std::vector<Ref> value = m.function_value;
  Values values = with_derivatives(dag, value);
  for (bool changed = !value.empty(); changed;) {
    changed = false;
    symbolic::Substitution substitute(dag, values);
    for (Ref& r : value) {
      const Ref next = substitute(r);
      changed = changed || next != r;
      r = next;
    }
    if (changed) values = with_derivatives(dag, value);
  }
  // The rates of integrals contain functions again.
  for (const auto& [symbol, rate] : dag.rates()) {
    if (symbol.kind == SymbolKind::integral) integrands.push_back({symbol.index, rate});
  }
  for (bool changed = !integrands.empty(); changed;) {
    changed = false;
    symbolic::Substitution substitute(dag, values);
    const auto replace = [&](Ref& r) {
      const Ref next = substitute(r);
      changed = changed || next != r;
      r = next;
    };
    for (auto& [symbol, r] : values) replace(r);
    for (Integrand& integrand : integrands) replace(integrand.rate);
  }
  return values;
}

bool holds_integral(const Dag& dag, Ref expression) {
  const std::vector<Symbol> symbols = dag.symbols({expression});
  return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::integral; });
}

// Integrals with a closed form, inner ones first. The others become states.
Values closed_integrals(const Mechanics& m, std::vector<Integrand>& integrands) {
  Dag& dag = *m.dag;
  Values closed;
  if (integrands.empty()) return closed;
  const Ref start = dag.symbol({SymbolKind::parameter, *m.model->start_time, 0});
  for (auto& [integral, rate] : integrands) {  // inner integrals come first
    symbolic::Substitution inner(dag, closed);
    rate = inner(rate);
    if (holds_integral(dag, rate)) continue;
    const auto found = symbolic::definite_integral(dag, rate, {SymbolKind::time, 0, 0}, start);
    if (found) closed[{SymbolKind::integral, integral, 0}] = *found;
  }
  return closed;
}

}  // namespace

symbolic::Substitution time_function_substitution(const Mechanics& m) {
  std::vector<Integrand> integrands;
  Values values = written_functions(m, integrands);
  const Values closed = closed_integrals(m, integrands);
  symbolic::Substitution substitute(*m.dag, closed);
  for (auto& [symbol, value] : values) value = substitute(value);
  values.insert(closed.begin(), closed.end());
  return {*m.dag, std::move(values)};
}

std::vector<NonelementaryIntegral> nonelementary_integrals(const Mechanics& m) {
  std::vector<Integrand> integrands;
  written_functions(m, integrands);
  const Values closed = closed_integrals(m, integrands);
  std::vector<NonelementaryIntegral> states;
  for (const auto& [integral, rate] : integrands) {
    if (!closed.contains({SymbolKind::integral, integral, 0})) states.push_back({integral, rate});
  }
  return states;
}

}  // namespace eomgen::mechanics
