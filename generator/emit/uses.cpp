// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/uses.hpp"

#include <algorithm>

#include "emit/expressions.hpp"
#include "program/parts.hpp"

namespace eomgen::emit {

Uses count_uses(const program::Function& function) {
  const std::vector<Instruction>& code = function.code;
  Uses uses{program::assign_parts(function), {}, {}, {}};
  uses.count.assign(code.size(), 0);
  uses.needed_later.assign(code.size(), false);
  uses.leaves.resize(uses.part.empty() ? 1 : uses.part.back() + 1);
  const auto use = [&](const Operand& operand, bool repeated, std::size_t part) {
    if (operand.slot == Slot::value) {
      uses.count[operand.index] += repeated ? 2 : 1;
      if (part != uses.part[operand.index]) uses.needed_later[operand.index] = true;
    } else {
      uses.leaves[part].insert({operand.slot, operand.index});
    }
  };
  for (std::size_t i = 0; i < code.size(); ++i) {
    const bool same_angle =
        code[i].pack != 0 && i > 0 && code[i - 1].pack == code[i].pack && code[i - 1].lane == code[i].lane;
    if (same_angle) continue;  // the pack prints the angle once
    for (const Operand& operand : code[i].operands) use(operand, repeats_operands(code[i].op), uses.part[i]);
  }
  for (const program::Result& result : function.results) {
    for (const Operand& operand : result.entries) use(operand, false, uses.leaves.size() - 1);
  }
  for (const program::PivotTest& test : function.pivots) {
    std::size_t part = 0;
    for (const Operand* operand : {&test.pivot, &test.scale})
      if (operand->slot == Slot::value) part = std::max(part, uses.part[operand->index]);
    use(test.pivot, true, part);
    use(test.scale, true, part);
  }
  return uses;
}

}  // namespace eomgen::emit
