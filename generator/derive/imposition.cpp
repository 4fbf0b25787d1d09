// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/imposition.hpp"

namespace eomgen::derive {
namespace {

using symbolic::Symbol;
using symbolic::SymbolKind;

constexpr std::uint8_t highest_order = 6;

}  // namespace

symbolic::Substitution impose(const Mechanics& m) {
  std::map<Symbol, Ref> values;
  for (const mechanics::FixedCoordinate& fixed : m.fixed) {
    values[{SymbolKind::coordinate, fixed.coordinate, 0}] = fixed.value;
    values[{SymbolKind::coordinate, fixed.coordinate, 1}] = fixed.rate;
    values[{SymbolKind::coordinate, fixed.coordinate, 2}] = fixed.acceleration;
  }
  return {*m.dag, std::move(values)};
}

symbolic::Substitution write_out(const Mechanics& m) {
  Dag& dag = *m.dag;
  const std::size_t n = m.function_value.size();
  // Functions may use one another, without cycles: n rounds reach the bottom of the longest chain.
  std::vector<Ref> value = m.function_value;
  for (std::size_t round = 0; round < n; ++round) {
    std::map<Symbol, Ref> values;
    for (std::uint32_t i = 0; i < n; ++i) {
      Ref derivative = value[i];
      symbolic::Derivation ddt = symbolic::total_time(dag, 0, n);
      for (std::uint8_t order = 0; order <= highest_order; ++order) {
        values[{SymbolKind::function, i, order}] = derivative;
        derivative = ddt(derivative);
      }
    }
    symbolic::Substitution substitute(dag, values);
    bool changed = false;
    for (std::uint32_t i = 0; i < n; ++i) {
      const Ref next = substitute(value[i]);
      changed = changed || next != value[i];
      value[i] = next;
    }
    if (!changed) return {dag, std::move(values)};
  }
  return {dag, {}};
}

}  // namespace eomgen::derive
