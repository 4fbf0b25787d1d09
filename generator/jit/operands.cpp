// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/operands.hpp"

#include <algorithm>

#include "jit/fold.hpp"
#include "program/internal_functions.hpp"
#include "program/numbers.hpp"
#include "symbolic/arithmetic.hpp"

namespace eomgen::jit {

using program::Instruction;
using symbolic::Op;

std::ptrdiff_t ready_after(const program::PivotTest& test) {
  std::ptrdiff_t last = -1;
  for (const Operand* operand : {&test.pivot, &test.scale}) {
    if (operand->slot == Slot::value) last = std::max(last, static_cast<std::ptrdiff_t>(operand->index));
  }
  return last;
}

Operands::Operands(const program::Function& function, std::span<const double> default_inputs, Constants& constants)
    : function_(function),
      constants_(constants),
      default_inputs_(default_inputs),
      takes_inputs_(program::takes_inputs(function.name)) {
  for (const symbolic::Rational& value : function.constants) numbers_.push_back(program::nearest_double(value));
  std::optional<std::vector<double>> standing;
  if (!takes_inputs_) standing.emplace(default_inputs.begin(), default_inputs.end());
  constant_ = fold_constants(function, numbers_, standing);
  absorbed_ = absorbed_arctangents(function);
  registers_.emplace(function.code.size(), UsePositions(function.code.size(), uses()), written_.steps);
}

bool Operands::is_same_group(std::uint32_t i, std::uint32_t k) const {
  return k < function_.code.size() && function_.code[i].pack != 0 && function_.code[k].pack == function_.code[i].pack;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> Operands::uses() const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> list;
  const auto add = [&](const Operand& operand, std::uint32_t position) {
    if (operand.slot == Slot::value && !constant_[operand.index]) list.emplace_back(operand.index, position);
  };
  std::vector<std::pair<std::uint32_t, const program::PivotTest*>> tests;
  for (const program::PivotTest& test : function_.pivots) {
    const std::ptrdiff_t last = ready_after(test);
    tests.emplace_back(last < 0 ? 0 : position_of(static_cast<std::uint32_t>(last)) + 1, &test);
  }
  std::stable_sort(tests.begin(), tests.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  auto test = tests.begin();
  const auto add_tests = [&](std::uint32_t until) {
    for (; test != tests.end() && test->first <= until; ++test) {
      add(test->second->pivot, test->first);
      add(test->second->scale, test->first);
    }
  };
  for (std::uint32_t i = 0; i < function_.code.size(); ++i) {
    add_tests(position_of(i));
    if (constant_[i] || absorbed_[i] || !is_first_of_group(i)) continue;
    for (std::uint32_t k = i; k == i || is_same_group(i, k); ++k) {
      for (const Operand& operand : read_operands(function_.code[k])) add(operand, position_of(i));
    }
  }
  add_tests(end());
  for (const program::Result& result : function_.results) {
    for (const Operand& entry : result.entries) add(entry, end());
  }
  return list;
}

bool Operands::absorbs_arctangent(const program::Instruction& instruction) const {
  return (instruction.op == Op::sin || instruction.op == Op::cos) && instruction.operands[0].slot == Slot::value &&
         absorbed_[instruction.operands[0].index];
}
const std::vector<Operand>& Operands::read_operands(const program::Instruction& instruction) const {
  return absorbs_arctangent(instruction) ? function_.code[instruction.operands[0].index].operands
                                         : instruction.operands;
}

bool Operands::is_argument(const Operand& operand) const {
  return operand.slot == Slot::state || operand.slot == Slot::parameter || operand.slot == Slot::prepared ||
         operand.slot == Slot::vector || (operand.slot == Slot::input && takes_inputs_);
}

std::optional<double> Operands::constant_value(const Operand& operand) const {
  std::optional<double> value;
  if (operand.slot == Slot::constant) value = numbers_[operand.index];
  if (operand.slot == Slot::value) value = constant_[operand.index];
  return value && operand.negated ? -*value : value;
}
Location Operands::location(const Operand& operand) {
  switch (operand.slot) {
    case Slot::constant: return constant(numbers_[operand.index]);
    case Slot::pi: return constant(symbolic::Binary64Arithmetic::pi());
    case Slot::time:
      // Filled before the first step, so it must not be shared with other values.
      if (!written_.reads_time) written_.time = registers_->new_scratch_block(1);
      written_.reads_time = true;
      return {Place::scratch, written_.time};
    case Slot::state: return {Place::state, operand.index};
    case Slot::parameter: return {Place::parameter, operand.index};
    case Slot::prepared:
    case Slot::vector: return {Place::prepared, operand.index};
    case Slot::input:
      if (!takes_inputs_) return constant(default_inputs_[operand.index]);
      return {Place::input, operand.index};
    case Slot::side:
    case Slot::contact: return mode_value(operand);
    case Slot::value: break;
  }
  if (constant_[operand.index]) return constant(*constant_[operand.index]);
  return registers_->location(operand.index);
}
Location Operands::mode_value(const Operand& operand) {
  const auto [found, is_new] = mode_values_.try_emplace({operand.slot, operand.index}, 0);
  if (is_new) {
    // Filled before the first step, as above.
    found->second = registers_->new_scratch_block(1);
    written_.mode_values.push_back({operand.slot == Slot::side, operand.index, found->second});
  }
  return {Place::scratch, found->second};
}

void Operands::drop(const std::vector<Operand>& operands) {
  for (const Operand& operand : operands) {
    if (is_value(operand)) registers_->drop_if_unused(operand.index);
  }
}

std::uint8_t Operands::copy(const Operand& operand) {
  const std::uint8_t reg = registers_->acquire();
  step(Action::load, reg, location(operand));
  if (operand.negated) step(Action::negate, reg);
  return reg;
}
Location Operands::signed_location(const Operand& operand, std::vector<std::uint8_t>& copies) {
  if (!operand.negated) return location(operand);
  copies.push_back(copy(operand));
  return {Place::register_, copies.back()};
}

bool Operands::is_free_to_overwrite(const std::vector<Operand>& operands, std::size_t k) {
  const Operand& operand = operands[k];
  if (!is_value(operand) || !registers_->in_register(operand.index) || !registers_->is_last_use(operand.index))
    return false;
  return std::count_if(operands.begin(), operands.end(),
                       [&](const Operand& o) { return o.slot == Slot::value && o.index == operand.index; }) == 1;
}
std::uint8_t Operands::start_from(const std::vector<Operand>& operands, std::size_t k) {
  if (is_free_to_overwrite(operands, k)) return registers_->take(operands[k].index);
  const std::uint8_t reg = registers_->acquire();
  step(Action::load, reg, location(operands[k]));
  return reg;
}

}  // namespace eomgen::jit
