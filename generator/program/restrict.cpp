// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/restrict.hpp"

namespace eomgen::program {

Function restrict_results(const Function& function, const std::vector<std::size_t>& entries) {
  std::vector<bool> needed(function.code.size(), false);
  const auto need = [&](const Operand& operand) {
    if (operand.slot == Slot::value) needed[operand.index] = true;
  };
  Function result;
  result.name = function.name;
  result.constants = function.constants;
  result.uses_input = function.uses_input;
  result.operations = function.operations;
  result.results.push_back({function.results[0].name, {}});
  for (const std::size_t i : entries) {
    result.results[0].entries.push_back(function.results[0].entries.at(i));
    need(result.results[0].entries.back());
  }
  for (std::size_t i = function.code.size(); i-- > 0;) {
    if (!needed[i]) continue;
    for (const Operand& operand : function.code[i].operands) need(operand);
  }
  std::vector<std::uint32_t> place(function.code.size(), 0);
  const auto moved = [&](Operand& operand) {
    if (operand.slot == Slot::value) operand.index = place[operand.index];
  };
  for (std::size_t i = 0; i < function.code.size(); ++i) {
    if (!needed[i]) continue;
    place[i] = static_cast<std::uint32_t>(result.code.size());
    result.code.push_back(function.code[i]);
    // A member of a pack may be alone now.
    result.code.back().pack = result.code.back().lane = 0;
    for (Operand& operand : result.code.back().operands) moved(operand);
  }
  for (Operand& operand : result.results[0].entries) moved(operand);
  return result;
}

}  // namespace eomgen::program
