// SPDX-License-Identifier: GPL-3.0-or-later
// The names of mechanics that every formulation uses.
#pragma once

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

using mechanics::constraint_substitution;
using mechanics::Mechanics;
using mechanics::time_function_substitution;
using mechanics::Vec3;
using symbolic::cross;
using symbolic::Dag;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// The states of first order of the system in the order of Model::states: those that the model declares, integrals of
/// functions of time without a closed form (time_function_substitution), discrete values.
inline std::vector<system::FirstOrderState> first_order_states(const Mechanics& mechanics) {
  symbolic::Substitution imposed = constraint_substitution(mechanics), written = time_function_substitution(mechanics);
  std::vector<system::FirstOrderState> states;
  for (const auto& [symbol, rate] : mechanics.dag->rates()) {
    if (symbol.kind == symbolic::SymbolKind::state) states.push_back({symbol, written(imposed(rate))});
  }
  for (const mechanics::NonelementaryIntegral& open : mechanics::nonelementary_integrals(mechanics))
    states.push_back({{symbolic::SymbolKind::integral, open.integral, 0}, open.rate});
  std::sort(states.begin(), states.end(), [](const system::FirstOrderState& a, const system::FirstOrderState& b) {
    return a.symbol.index < b.symbol.index;
  });
  return states;
}

}  // namespace eomgen::derive
