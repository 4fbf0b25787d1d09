// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/operations.hpp"

#include <algorithm>
#include <stdexcept>

namespace eomgen::jit {

using program::Instruction;
using symbolic::Op;

namespace {

Library library_of(Op op) {
  switch (op) {
    case Op::pow: return Library::pow;
    case Op::sin: return Library::sin;
    case Op::cos: return Library::cos;
    case Op::tan: return Library::tan;
    case Op::asin: return Library::asin;
    case Op::acos: return Library::acos;
    case Op::atan: return Library::atan;
    case Op::sinh: return Library::sinh;
    case Op::cosh: return Library::cosh;
    case Op::tanh: return Library::tanh;
    case Op::exp: return Library::exp;
    case Op::log: return Library::log;
    case Op::atan2: return Library::atan2;
    default: throw std::logic_error("there is no machine code for this operation");
  }
}

}  // namespace

void Operations::instruction(std::uint32_t i) {
  if (is_omitted(i)) return;
  const Instruction& instruction = function().code[i];
  if (instruction.pack != 0) {
    if (is_first_of_group(i)) sincos_group(i);
    return;
  }
  const std::optional<std::uint8_t> target = computed(instruction);
  drop(read_operands(instruction));
  if (target) registers().assign(*target, i);
  registers().drop_if_unused(i);
}

std::optional<std::uint8_t> Operations::computed(const Instruction& instruction) {
  const std::vector<Operand>& o = instruction.operands;
  switch (instruction.op) {
    case Op::add: return sum(o);
    case Op::mul: return product(o);
    case Op::div: return quotient(o);
    case Op::sqrt: return root(o);
    case Op::abs: {
      const std::uint8_t reg = start_from(o, 0);
      step(Action::absolute, reg);
      return reg;
    }
    case Op::sign: {
      const std::uint8_t reg = start_from(o, 0);
      if (o[0].negated) step(Action::negate, reg);
      step(Action::sign, reg);
      return reg;
    }
    case Op::min:
    case Op::max: return extreme(instruction.op, o);
    case Op::select: return selected(o);
    case Op::sin:
    case Op::cos:
      if (absorbs_arctangent(instruction)) return of_arctangent(instruction.op, read_operands(instruction)[0]);
      break;
    case Op::pow:
      if (const std::optional<std::uint8_t> special = small_power(o)) return special;
      break;
    default: break;
  }
  return library_call(instruction.op, o);
}

/// The first two operands of a sum or product commute: the one whose register can be overwritten goes first.
std::vector<Operand> Operations::with_best_first(const std::vector<Operand>& operands) {
  std::vector<Operand> o = operands;
  if (o.size() > 1 && !is_free_to_overwrite(o, 0) && is_free_to_overwrite(o, 1)) std::swap(o[0], o[1]);
  return o;
}
std::uint8_t Operations::sum(const std::vector<Operand>& operands) {
  const bool swappable = operands.size() > 1 && !operands[0].negated && !operands[1].negated;
  const std::vector<Operand> o = swappable ? with_best_first(operands) : operands;
  const std::uint8_t reg = start_from(o, 0);
  if (o[0].negated) step(Action::negate, reg);
  for (std::size_t k = 1; k < o.size(); ++k) step(o[k].negated ? Action::subtract : Action::add, reg, location(o[k]));
  return reg;
}
std::uint8_t Operations::product(const std::vector<Operand>& operands) {
  const std::vector<Operand> o = with_best_first(operands);
  const std::uint8_t reg = start_from(o, 0);
  if (std::count_if(o.begin(), o.end(), [](const Operand& operand) { return operand.negated; }) % 2 == 1)
    step(Action::negate, reg);
  for (std::size_t k = 1; k < o.size(); ++k) step(Action::multiply, reg, location(o[k]));
  return reg;
}
std::uint8_t Operations::quotient(const std::vector<Operand>& o) {
  const std::uint8_t reg = start_from(o, 0);
  if (o[0].negated != o[1].negated) step(Action::negate, reg);
  step(Action::divide, reg, location(o[1]));
  return reg;
}
std::uint8_t Operations::root(const std::vector<Operand>& o) {
  if (!o[0].negated && !is_free_to_overwrite(o, 0)) {
    const std::uint8_t reg = registers().acquire();
    step(Action::root, reg, location(o[0]));
    return reg;
  }
  const std::uint8_t reg = start_from(o, 0);
  if (o[0].negated) step(Action::negate, reg);
  step(Action::root, reg, {Place::register_, reg});
  return reg;
}
/// b < a ? b : a, or a < b ? b : a
std::uint8_t Operations::extreme(Op op, const std::vector<Operand>& o) {
  std::vector<std::uint8_t> copies;
  const std::uint8_t reg = copy(o[1]);
  step(op == Op::min ? Action::least : Action::greatest, reg, signed_location(o[0], copies));
  for (const std::uint8_t one : copies) registers().release(one);
  return reg;
}
/// a < b ? x : y
std::uint8_t Operations::selected(const std::vector<Operand>& o) {
  std::vector<std::uint8_t> copies;
  const std::uint8_t result = copy(o[2]), b = copy(o[1]);
  const Location other = signed_location(o[3], copies), a = signed_location(o[0], copies);
  step(Action::compare, b, a);
  step(Action::load_unless_above, result, other);
  for (const std::uint8_t one : copies) registers().release(one);
  registers().release(b);
  return result;
}

/// sin(atan(x)) = x/sqrt(x^2 + 1), cos(atan(x)) = 1/sqrt(x^2 + 1); their limits where x^2 could overflow.
std::uint8_t Operations::of_arctangent(Op op, const Operand& argument) {
  constexpr double limit = 0x1.fffffffffffffp+511;
  const std::uint8_t x = copy(argument), root = registers().acquire(), value = registers().acquire(),
                     far = registers().acquire();
  step(Action::load, root, {Place::register_, x});
  step(Action::multiply, root, {Place::register_, x});
  step(Action::add, root, constant(1));
  step(Action::root, root, {Place::register_, root});
  step(Action::load, value, op == Op::sin ? Location{Place::register_, x} : constant(1));
  step(Action::divide, value, {Place::register_, root});
  step(Action::load, far, constant(op == Op::sin ? 1 : 0));
  step(Action::load, root, {Place::register_, x});
  step(Action::add_sign, far, {Place::register_, root});
  step(Action::absolute, x);
  step(Action::load, root, constant(limit));
  step(Action::compare, root, {Place::register_, x});
  step(Action::load_unless_above, value, {Place::register_, far});
  for (const std::uint8_t one : {x, root, far}) registers().release(one);
  return value;
}

/// Powers that compilers do not leave to the C library.
std::optional<std::uint8_t> Operations::small_power(const std::vector<Operand>& o) {
  const std::optional<double> exponent = constant_value(o[1]);
  if (constant_value(o[0]) == 1.0) {
    const std::uint8_t reg = registers().acquire();
    step(Action::load, reg, constant(1));
    return reg;
  }
  if (!exponent) return std::nullopt;
  if (*exponent == 2) return product({o[0], o[0]});
  if (*exponent == 1) return copy(o[0]);
  if (*exponent != -1 && *exponent != 0) return std::nullopt;
  const std::uint8_t reg = registers().acquire();
  step(Action::load, reg, constant(*exponent == -1 && o[0].negated ? -1.0 : 1.0));
  if (*exponent == -1) step(Action::divide, reg, location(o[0]));
  return reg;
}

std::uint8_t Operations::library_call(Op op, const std::vector<Operand>& o) {
  registers().store_for_call();
  if (o.size() == 2) {  // loading one argument must not overwrite the other
    for (const Operand& operand : o) {
      if (is_value(operand) && registers().in_register(operand.index)) registers().store(operand.index);
    }
    step(Action::load, 1, in_memory(o[1]));
    if (o[1].negated) step(Action::negate, 1);
  }
  step(Action::load, 0, o.size() == 2 ? in_memory(o[0]) : location(o[0]));
  if (o[0].negated) step(Action::negate, 0);
  step(Action::call, 0, {}, static_cast<std::uint32_t>(library_of(op)));
  registers().empty_after_call();
  return registers().acquire();  // register 0
}
Location Operations::in_memory(const Operand& operand) {
  return is_value(operand) ? registers().memory(operand.index) : location(operand);
}

/// Sines and cosines from the function that the emitted C brings along (templates/kernels).
void Operations::sincos_group(std::uint32_t first) {
  const std::vector<Instruction>& code = function().code;
  std::uint32_t last = first, angles = 0;
  while (last == first || is_same_group(first, last)) angles = std::max(angles, code[last++].lane + 1);
  const std::uint32_t block = registers().new_scratch_block(3 * angles);
  std::vector<char> is_taken(3 * static_cast<std::size_t>(angles), false);
  for (std::uint32_t i = first; i < last; ++i) {
    const Operand& angle = code[i].operands[0];
    const std::uint32_t place = block + code[i].lane;
    if (std::exchange(is_taken[code[i].lane], true)) continue;
    const bool is_ready = is_value(angle) && !angle.negated && registers().in_register(angle.index);
    const std::uint8_t reg =
        is_ready ? static_cast<std::uint8_t>(registers().location(angle.index).index) : copy(angle);
    step(Action::store, reg, {Place::scratch, place});
    if (!is_ready) registers().release(reg);
  }
  registers().store_for_call();
  step(Action::sincos_group, 0, {Place::scratch, block}, angles);
  registers().empty_after_call();
  for (std::uint32_t i = first; i < last; ++i) {
    const std::uint32_t offset = (code[i].op == Op::sin ? angles : 2 * angles) + code[i].lane;
    if (std::exchange(is_taken[offset], true)) throw std::logic_error("a sine is computed twice");
    registers().assign_scratch(block + offset, i);
  }
  for (std::uint32_t i = first; i < last; ++i) {
    drop(code[i].operands);
    registers().drop_if_unused(i);
  }
  for (std::uint32_t k = 0; k < is_taken.size(); ++k) {
    if (k < angles || !is_taken[k]) registers().free_scratch(block + k);
  }
}

}  // namespace eomgen::jit
