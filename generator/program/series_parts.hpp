// SPDX-License-Identifier: GPL-3.0-or-later
// Power series of the values of a right-hand side: the building blocks of the recurrences.
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "program/program.hpp"

namespace eomgen::program {

inline Operand negate(Operand operand) {
  operand.negated = !operand.negated;
  return operand;
}

/// A value of the right-hand side. `zero`: coefficient of order 0, in `start`; `next`: coefficient of order k, in
/// `next`, if the value depends on time or state.
struct Series {
  bool varies = false;
  Operand zero, next;
};
inline Series negate(Series series) { return {series.varies, negate(series.zero), negate(series.next)}; }

using Key = std::tuple<Slot, std::uint32_t, bool>;
inline Key key(const Operand& o) { return {o.slot, o.index, o.negated}; }
using Keys = std::pair<Key, Key>;
inline Keys keys(const Series& s) { return {key(s.zero), key(s.next)}; }

inline Operand constant(Function& function, const symbolic::Rational& value) {
  auto& list = function.constants;
  const auto found = std::find(list.begin(), list.end(), value);
  const auto index = static_cast<std::uint32_t>(found - list.begin());
  if (found == list.end()) list.push_back(value);
  return {Slot::constant, index, false};
}

inline Operand append_instruction(Function& function, symbolic::Op op, std::vector<Operand> operands,
                                  std::string name = {}) {
  if (operands.size() == 1 && (op == symbolic::Op::add || op == symbolic::Op::mul)) return operands[0];
  Instruction instruction;
  instruction.op = op;
  instruction.operands = std::move(operands);
  instruction.name = std::move(name);
  function.code.push_back(std::move(instruction));
  return {Slot::value, static_cast<std::uint32_t>(function.code.size() - 1), false};
}

}  // namespace eomgen::program
