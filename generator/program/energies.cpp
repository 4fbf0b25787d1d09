// SPDX-License-Identifier: GPL-3.0-or-later
// In: the energies of an EquationSystem. Out: the function `energy_gradients` of the ABI.
#include "program/abi_functions.hpp"

namespace eomgen::program {

FunctionExpressions AbiFunctions::energy_gradients() {
  const Ref T = system_.kinetic, U = system_.potential;
  FunctionExpressions function{"energy_gradients", {{"energies", {T, U}}, {"dT", {}}, {"dU", {}}}, {}, {}};
  for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
    for (const std::uint32_t i : system_.free) {
      symbolic::Derivation d = symbolic::partial_derivative(*system_.dag, {symbolic::SymbolKind::coordinate, i, order});
      function.results[1].entries.push_back(d(T));
      if (order == 0) function.results[2].entries.push_back(d(U));
    }
  }
  return function;
}

}  // namespace eomgen::program
