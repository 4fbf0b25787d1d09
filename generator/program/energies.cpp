// SPDX-License-Identifier: GPL-3.0-or-later
// In: the energies of an EquationSystem. Out: the functions `energy_gradients` and `gravity` of the ABI.
#include "program/abi_functions.hpp"
#include "symbolic/adjoint.hpp"

namespace eomgen::program {

std::vector<Ref> AbiFunctions::energy_slopes(Ref energy, std::uint8_t order) {
  std::vector<symbolic::Symbol> symbols;
  for (const std::uint32_t i : system_.free) symbols.push_back({symbolic::SymbolKind::coordinate, i, order});
  return symbolic::gradient(*system_.dag, {energy}, {system_.dag->one()}, symbols);
}

FunctionExpressions AbiFunctions::energy_gradients() {
  FunctionExpressions function = empty_function("energy_gradients");
  function.results[0].entries = {system_.kinetic, system_.potential};
  for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
    const std::vector<Ref> slopes = energy_slopes(system_.kinetic, order);
    function.results[1].entries.insert(function.results[1].entries.end(), slopes.begin(), slopes.end());
  }
  function.results[2].entries = energy_slopes(system_.potential, 0);
  return function;
}

FunctionExpressions AbiFunctions::gravity() {
  FunctionExpressions function = empty_function("gravity");
  function.results[0].entries = energy_slopes(system_.potential, 0);
  return function;
}

}  // namespace eomgen::program
