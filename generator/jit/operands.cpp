// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/operands.hpp"

#include <cln/dfloat.h>
#include <cln/float.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "numeric/numbers.hpp"
#include "program/internal_functions.hpp"
#include "program/numbers.hpp"
#include "program/parts.hpp"
#include "symbolic/arithmetic.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::jit {

using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

UsePositions::UsePositions(std::size_t values, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& uses)
    : begin_(values + 1, 0), positions_(uses.size()) {
  for (const auto& [value, position] : uses) ++begin_[value + 1];
  for (std::size_t i = 0; i < values; ++i) begin_[i + 1] += begin_[i];
  cursor_.assign(begin_.begin(), begin_.end() - 1);
  for (const auto& [value, position] : uses) positions_[cursor_[value]++] = position;
  cursor_.assign(begin_.begin(), begin_.end() - 1);
}

std::uint32_t UsePositions::next(std::uint32_t value, std::uint32_t position) {
  std::uint32_t& at = cursor_[value];
  while (at < begin_[value + 1] && positions_[at] < position) ++at;
  return at < begin_[value + 1] ? positions_[at] : never;
}

bool UsePositions::has_use_after(std::uint32_t value, std::uint32_t position) {
  next(value, position);
  const std::uint32_t end = begin_[value + 1];
  return cursor_[value] < end && positions_[end - 1] > position;
}

Location Registers::location(std::uint32_t value) const {
  const Held& held = value_[value];
  if (held.reg != none) return {Place::register_, held.reg};
  if (held.scratch == nowhere) throw std::logic_error("a value is used that is nowhere");
  return {Place::scratch, held.scratch};
}

std::uint8_t Registers::acquire() {
  std::uint8_t best = none;
  std::uint32_t furthest = 0;
  for (std::uint8_t r = 0; r < register_count; ++r) {
    if (holds_[r] == reserved) continue;
    if (holds_[r] == nothing) {
      holds_[r] = reserved;
      return r;
    }
    const std::uint32_t next = uses_.next(holds_[r], position_);
    // Of equally far ones a value that need not be stored gives way.
    const bool better = best == none || next > furthest || (next == furthest && value_[holds_[r]].scratch != nowhere);
    if (better) best = r, furthest = next;
  }
  if (best == none) throw std::logic_error("no register is left");
  store(holds_[best]);
  value_[holds_[best]].reg = none;
  holds_[best] = reserved;
  return best;
}

std::uint8_t Registers::take(std::uint32_t value) {
  const std::uint8_t reg = value_[value].reg;
  value_[value].reg = none;
  holds_[reg] = reserved;
  return reg;
}

void Registers::assign(std::uint8_t reg, std::uint32_t value) {
  holds_[reg] = value;
  value_[value].reg = reg;
}

void Registers::drop_if_unused(std::uint32_t value) {
  Held& held = value_[value];
  if (!is_last_use(value)) return;
  if (held.reg != none) holds_[held.reg] = nothing;
  if (held.scratch != nowhere) free_scratch(held.scratch);
  held = {};
}

void Registers::store_for_call() {
  for (const std::uint32_t value : holds_) {
    if (value != nothing && value != reserved && !is_last_use(value)) store(value);
  }
}

void Registers::empty_after_call() {
  for (std::uint32_t& value : holds_) {
    if (value == nothing) continue;
    if (value != reserved) value_[value].reg = none;
    value = nothing;
  }
}

void Registers::store(std::uint32_t value) {
  Held& held = value_[value];
  if (held.scratch != nowhere) return;
  held.scratch = new_scratch();
  steps_.push_back({Action::store, held.reg, {Place::scratch, held.scratch}, 0});
}

std::uint32_t Registers::new_scratch() {
  if (free_.empty()) return scratch_size_++;
  const std::uint32_t index = free_.back();
  free_.pop_back();
  return index;
}

std::uint32_t Registers::new_scratch_block(std::uint32_t size) {
  const std::uint32_t first = scratch_size_;
  scratch_size_ += size;
  return first;
}

namespace {

// Optimisations of gcc -O2 that change bits of results of the emitted C: values that depend on constants alone are
// rounded once, where the C library may be wrong in the last place; sines and cosines of arctangents become algebraic
// (gcc/match.pd). Functions that are cut into parts (program/parts.hpp) are optimised part by part.

constexpr std::uintptr_t digits = 60;

/// The function rounded once; its value in binary64 where it has none among real numbers.
double rounded_once(Op op, const std::vector<double>& arguments) {
  using Binary64 = symbolic::Binary64Arithmetic;
  const auto in_binary64 = [&] {
    return symbolic::value_of(
        op, 0, [&](std::size_t i) { return arguments[i]; }, Binary64{});
  };
  for (const double argument : arguments) {
    if (!std::isfinite(argument)) return in_binary64();
  }
  try {
    const symbolic::ClnArithmetic number{cln::float_format(digits)};
    const cln::cl_R value = symbolic::value_of(
        op, 0, [&](std::size_t i) { return number.constant(numeric::exact(arguments[i])); }, number);
    // The nearest double: of few significant digits, or zero.
    const double near = in_binary64();
    if (near == 0 || !std::isnormal(near)) return near;
    const double result = cln::double_approx(cln::cl_float(value, cln::float_format_dfloat));
    return result == 0 ? near : result;
  } catch (const std::domain_error&) {
    return in_binary64();
  }
}

double folded(Op op, const std::vector<double>& o) {
  switch (op) {
    case Op::add:
    case Op::mul: {
      double result = o[0];
      for (std::size_t i = 1; i < o.size(); ++i) result = op == Op::add ? result + o[i] : result * o[i];
      return result;
    }
    case Op::div: return o[0] / o[1];
    case Op::sqrt: return std::sqrt(o[0]);
    case Op::abs: return std::fabs(o[0]);
    case Op::sign: return o[0] > 0 ? 1 : o[0] < 0 ? -1 : 0;
    case Op::min: return o[1] < o[0] ? o[1] : o[0];
    case Op::max: return o[0] < o[1] ? o[1] : o[0];
    case Op::select: return o[0] < o[1] ? o[2] : o[3];
    default: return rounded_once(op, o);
  }
}

/// The constant value of each instruction, if it has one. `inputs`: values of the inputs where a function takes none.
std::vector<std::optional<double>> fold_constants(const program::Function& function, std::span<const double> constants,
                                                  const std::optional<std::vector<double>>& inputs) {
  std::vector<std::optional<double>> value(function.code.size());
  const std::vector<std::size_t> part = program::assign_parts(function);
  std::vector<double> operands;
  const auto take = [&](const Operand& operand, std::size_t reader) {
    std::optional<double> found;
    switch (operand.slot) {
      case Slot::constant: found = constants[operand.index]; break;
      case Slot::pi: found = symbolic::Binary64Arithmetic::pi(); break;
      case Slot::input:
        if (inputs) found = inputs->at(operand.index);
        break;
      case Slot::value:
        if (part[operand.index] == part[reader]) found = value[operand.index];
        break;
      default: break;
    }
    if (found) operands.push_back(operand.negated ? -*found : *found);
    return found.has_value();
  };
  for (std::size_t i = 0; i < function.code.size(); ++i) {
    const Instruction& instruction = function.code[i];
    operands.clear();
    bool constant = instruction.pack == 0;  // the kernel for several angles has roundings of its own
    for (const Operand& operand : instruction.operands) constant = constant && take(operand, i);
    if (constant) value[i] = folded(instruction.op, operands);
  }
  return value;
}

/// The arctangents that nothing but one sine or cosine uses.
std::vector<bool> absorbed_arctangents(const program::Function& function) {
  const std::vector<Instruction>& code = function.code;
  const std::vector<std::size_t> part = program::assign_parts(function);
  std::vector<std::uint32_t> uses(code.size(), 0);
  const auto use = [&](const Operand& operand) {
    if (operand.slot == Slot::value) ++uses[operand.index];
  };
  for (const Instruction& instruction : code)
    std::for_each(instruction.operands.begin(), instruction.operands.end(), use);
  for (const program::Result& result : function.results)
    std::for_each(result.entries.begin(), result.entries.end(), use);
  for (const program::PivotTest& test : function.pivots) use(test.pivot), use(test.scale);
  std::vector<bool> absorbed(code.size(), false);
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i].pack != 0 || (code[i].op != Op::sin && code[i].op != Op::cos)) continue;
    const Operand& angle = code[i].operands[0];
    if (angle.slot != Slot::value || code[angle.index].op != Op::atan) continue;
    const bool is_direct = !angle.negated || code[i].op == Op::cos;  // -sin(a) is not written as sin(-a)
    absorbed[angle.index] = is_direct && uses[angle.index] == 1 && part[angle.index] == part[i];
  }
  return absorbed;
}

}  // namespace

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
