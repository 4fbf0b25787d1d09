// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/assign.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "jit/operands.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::jit {

using program::Function;
using program::Instruction;
using program::PivotTest;
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

/// The steps of instructions, with the operations, their order and the roundings of the emitted C
/// (emit/expressions.hpp).
class Operations : public Operands {
 public:
  using Operands::Operands;

  /// Writes the steps of an instruction; those of a group of sines and cosines with its first one.
  void instruction(std::uint32_t i) {
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

 private:
  std::optional<std::uint8_t> computed(const Instruction& instruction) {
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
  std::vector<Operand> with_best_first(const std::vector<Operand>& operands) {
    std::vector<Operand> o = operands;
    if (o.size() > 1 && !is_free_to_overwrite(o, 0) && is_free_to_overwrite(o, 1)) std::swap(o[0], o[1]);
    return o;
  }

  std::uint8_t sum(const std::vector<Operand>& operands) {
    const bool swappable = operands.size() > 1 && !operands[0].negated && !operands[1].negated;
    const std::vector<Operand> o = swappable ? with_best_first(operands) : operands;
    const std::uint8_t reg = start_from(o, 0);
    if (o[0].negated) step(Action::negate, reg);
    for (std::size_t k = 1; k < o.size(); ++k) step(o[k].negated ? Action::subtract : Action::add, reg, location(o[k]));
    return reg;
  }

  std::uint8_t product(const std::vector<Operand>& operands) {
    const std::vector<Operand> o = with_best_first(operands);
    const std::uint8_t reg = start_from(o, 0);
    if (std::count_if(o.begin(), o.end(), [](const Operand& operand) { return operand.negated; }) % 2 == 1)
      step(Action::negate, reg);
    for (std::size_t k = 1; k < o.size(); ++k) step(Action::multiply, reg, location(o[k]));
    return reg;
  }

  std::uint8_t quotient(const std::vector<Operand>& o) {
    const std::uint8_t reg = start_from(o, 0);
    if (o[0].negated != o[1].negated) step(Action::negate, reg);
    step(Action::divide, reg, location(o[1]));
    return reg;
  }

  std::uint8_t root(const std::vector<Operand>& o) {
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
  std::uint8_t extreme(Op op, const std::vector<Operand>& o) {
    std::vector<std::uint8_t> copies;
    const std::uint8_t reg = copy(o[1]);
    step(op == Op::min ? Action::least : Action::greatest, reg, signed_location(o[0], copies));
    for (const std::uint8_t one : copies) registers().release(one);
    return reg;
  }

  /// a < b ? x : y
  std::uint8_t selected(const std::vector<Operand>& o) {
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
  std::uint8_t of_arctangent(Op op, const Operand& argument) {
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
  std::optional<std::uint8_t> small_power(const std::vector<Operand>& o) {
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

  std::uint8_t library_call(Op op, const std::vector<Operand>& o) {
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

  Location in_memory(const Operand& operand) {
    return is_value(operand) ? registers().memory(operand.index) : location(operand);
  }

  /// Sines and cosines from the function that the emitted C brings along (templates/kernels).
  void sincos_group(std::uint32_t first) {
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
};

class Assignment : Operations {
 public:
  Assignment(const Function& function, std::span<const double> default_inputs, std::size_t free_count,
             Constants& constants)
      : Operations(function, default_inputs, constants), free_count_(free_count) {}

  FunctionSteps run() {
    written().inputs = program::inputs_of(function().name);
    std::vector<std::vector<const PivotTest*>> tests(function().code.size() + 1);
    for (const PivotTest& test : function().pivots)
      tests[static_cast<std::size_t>(ready_after(test) + 1)].push_back(&test);
    test_pivots(tests[0]);
    for (std::uint32_t i = 0; i < function().code.size(); ++i) {
      registers().move_to(position_of(i));
      instruction(i);
      registers().move_to(position_of(i) + 1);
      test_pivots(tests[i + 1]);
    }
    registers().move_to(end());
    write_results();
    written().scratch_size = registers().scratch_size();
    return std::move(written());
  }

 private:
  void test_pivots(const std::vector<const PivotTest*>& tests) {
    for (const PivotTest* test : tests) test_pivot(*test);
    for (const PivotTest* test : tests) drop({test->pivot, test->scale});  // several may have the same scale
  }
  void test_pivot(const PivotTest& test) {
    const std::uint8_t pivot = registers().acquire();
    step(Action::load, pivot, location(test.pivot));
    if (test.scale.slot == Slot::constant && *constant_value(test.scale) == 0) {
      step(Action::compare, pivot, constant(0));
      step(Action::return_if_equal, 0, {}, 1);
    } else {
      const std::uint8_t least = registers().acquire();
      step(Action::load, least, location(test.scale));
      step(Action::absolute, least);
      step(Action::multiply, least, constant(program::pivot_tolerance));
      step(Action::absolute, pivot);
      step(Action::compare, least, {Place::register_, pivot});
      step(Action::return_if_above_or_equal, 0, {}, 1);
      registers().release(least);
    }
    registers().release(pivot);
  }

  // Results

  /// Entries that are arguments are copied first: a result array may be an argument array.
  void copy_arguments() {
    for (const program::Result& result : function().results) {
      if (result.is_test()) continue;
      for (const Operand& entry : result.entries) {
        if (!is_argument(entry) || copies_.contains({entry.slot, entry.index})) continue;
        const std::uint8_t reg = registers().acquire();
        const std::uint32_t place = registers().new_scratch();
        step(Action::load, reg, location(entry));
        step(Action::store, reg, {Place::scratch, place});
        registers().release(reg);
        copies_[{entry.slot, entry.index}] = place;
      }
    }
  }
  Location entry_location(const Operand& entry) {
    const auto found = copies_.find({entry.slot, entry.index});
    return found == copies_.end() ? location(entry) : Location{Place::scratch, found->second};
  }

  void write_results() {
    copy_arguments();
    std::uint32_t r = 0;  // among the arrays
    for (std::size_t k = 0; k < function().results.size(); ++k) {
      const program::Result& result = function().results[k];
      if (result.is_test()) {
        test_entries(result);
        continue;
      }
      written().may_be_null.push_back(program::may_be_null(function().name, k));
      step(Action::begin_result, 0, {}, r);
      for (std::uint32_t i = 0; i < result.entries.size(); ++i) {
        const std::uint32_t place = k > 0 || function().result_indices.empty() ? i : function().result_indices[i];
        write(result.entries[i], {Place::result, place});
      }
      step(Action::end_result, 0, {}, r++);
    }
    if (!program::is_right_hand_side(function())) return;
    const auto dx = std::find_if(function().results.begin(), function().results.end(),
                                 [](const program::Result& result) { return !result.is_test(); });
    written().finite_from = static_cast<std::uint32_t>(free_count_);
    written().finite_to = static_cast<std::uint32_t>(dx->entries.size());
  }
  void test_entries(const program::Result& result) {
    for (const Operand& entry : result.entries) {
      const std::uint8_t zero = registers().acquire(), value = copy(entry);
      step(Action::load, zero, constant(0));
      step(Action::compare, zero, {Place::register_, value});
      step(Action::return_if_above, 0, {}, static_cast<std::uint32_t>(result.code));
      registers().release(zero);
      registers().release(value);
    }
  }
  void write(const Operand& entry, Location to) {
    const Location from = entry_location(entry);
    if (from.place == Place::register_ && !entry.negated)
      return step(Action::store, static_cast<std::uint8_t>(from.index), to);
    const std::uint8_t reg = registers().acquire();
    step(Action::load, reg, from);
    if (entry.negated) step(Action::negate, reg);
    step(Action::store, reg, to);
    registers().release(reg);
  }

  std::size_t free_count_;
  std::map<std::pair<Slot, std::uint32_t>, std::uint32_t> copies_;
};

}  // namespace

FunctionSteps assign_registers(const Function& function, std::span<const double> default_inputs, std::size_t free_count,
                               Constants& constants) {
  return Assignment(function, default_inputs, free_count, constants).run();
}

}  // namespace eomgen::jit
