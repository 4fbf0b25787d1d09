// SPDX-License-Identifier: GPL-3.0-or-later
// The operands of a function while its steps are written: where their values are, and how long they are needed.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "jit/steps.hpp"
#include "program/program.hpp"

namespace eomgen::jit {

/// Positions at which values are used, ascending for each value.
class UsePositions {
 public:
  /// `uses`: pairs of value and position, by ascending position.
  UsePositions(std::size_t values, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& uses);

  static constexpr std::uint32_t never = ~0u;
  /// The first use at `position` or later. Positions must not decrease from call to call.
  std::uint32_t next(std::uint32_t value, std::uint32_t position);
  /// Whether there is a use after `position`.
  bool has_use_after(std::uint32_t value, std::uint32_t position);

 private:
  std::vector<std::uint32_t> begin_, positions_, cursor_;
};

/// The values of a function in registers and in the scratch array, while its steps are written.
class Registers {
 public:
  Registers(std::size_t values, UsePositions uses, std::vector<Step>& steps)
      : uses_(std::move(uses)), steps_(steps), value_(values) {
    holds_.fill(nothing);
  }

  /// The current position in the program.
  void move_to(std::uint32_t position) { position_ = position; }

  Location location(std::uint32_t value) const;
  /// The place of a stored value in the scratch array.
  Location memory(std::uint32_t value) const { return {Place::scratch, value_[value].scratch}; }
  bool in_register(std::uint32_t value) const { return value_[value].reg != none; }
  /// Whether nothing after the current position needs the value.
  bool is_last_use(std::uint32_t value) { return !uses_.has_use_after(value, position_); }

  /// A register for a new value; another value may move to the scratch array.
  std::uint8_t acquire();
  /// The register of a value, which is no longer there.
  std::uint8_t take(std::uint32_t value);
  void release(std::uint8_t reg) { holds_[reg] = nothing; }
  /// The register now holds this value.
  void assign(std::uint8_t reg, std::uint32_t value);
  /// The value is in the scratch array.
  void assign_scratch(std::uint32_t index, std::uint32_t value) { value_[value].scratch = index; }
  /// Frees what holds a value without later uses.
  void drop_if_unused(std::uint32_t value);
  /// Stores what is needed later. After a call all registers are empty: the C library preserves none.
  void store_for_call();
  void empty_after_call();
  /// Stores the value in the scratch array if it is not there.
  void store(std::uint32_t value);

  std::uint32_t new_scratch();
  void free_scratch(std::uint32_t index) { free_.push_back(index); }
  std::uint32_t new_scratch_block(std::uint32_t size);
  std::uint32_t scratch_size() const { return scratch_size_; }

 private:
  static constexpr std::uint8_t none = 255;
  static constexpr std::uint32_t nothing = ~0u, reserved = ~0u - 1;
  static constexpr std::uint32_t nowhere = ~0u;
  struct Held {
    std::uint8_t reg = none;
    std::uint32_t scratch = nowhere;
  };

  UsePositions uses_;
  std::vector<Step>& steps_;
  std::vector<Held> value_;
  std::array<std::uint32_t, register_count> holds_{};  // value, nothing, or reserved
  std::vector<std::uint32_t> free_;
  std::uint32_t scratch_size_ = 0, position_ = 0;
};

using program::Operand;
using program::Slot;

/// The instruction after which a test can be made; -1: at once.
std::ptrdiff_t ready_after(const program::PivotTest& test);

class Operands {
 public:
  Operands(const program::Function& function, std::span<const double> default_inputs, Constants& constants);

  // Position 0 is the start of the function. Instruction i has position 2 i + 1, tests after it 2 i + 2.
  static std::uint32_t position_of(std::uint32_t instruction) { return 2 * instruction + 1; }
  std::uint32_t end() const { return position_of(static_cast<std::uint32_t>(function_.code.size())); }

  Registers& registers() { return *registers_; }
  const program::Function& function() const { return function_; }
  /// Whether the instruction has no steps of its own.
  bool is_omitted(std::uint32_t instruction) const { return constant_[instruction] || absorbed_[instruction]; }
  /// Whether sines and cosines are computed together.
  bool is_same_group(std::uint32_t i, std::uint32_t k) const;
  bool is_first_of_group(std::uint32_t i) const { return i == 0 || !is_same_group(i, i - 1); }
  bool absorbs_arctangent(const program::Instruction& instruction) const;
  /// The operands, or those of an arctangent that the instruction absorbs.
  const std::vector<Operand>& read_operands(const program::Instruction& instruction) const;
  std::optional<double> constant_value(const Operand& operand) const;
  /// Whether the operand is computed by an instruction with steps.
  bool is_value(const Operand& operand) const { return operand.slot == Slot::value && !constant_[operand.index]; }
  bool is_argument(const Operand& operand) const;

  void step(Action action, std::uint8_t target, Location source = {}, std::uint32_t extra = 0) {
    written_.steps.push_back({action, target, source, extra});
  }
  Location constant(double value) { return {Place::constant, constants_.index(value)}; }
  /// The place of the unsigned value of an operand.
  Location location(const Operand& operand);
  /// The place of the signed value of an operand; in `copies` if it had to be negated.
  Location signed_location(const Operand& operand, std::vector<std::uint8_t>& copies);
  /// A register with the signed value of an operand, to be overwritten or released.
  std::uint8_t copy(const Operand& operand);
  /// Whether an operand's register can be overwritten: its value has no later use and no other use here.
  bool is_free_to_overwrite(const std::vector<Operand>& operands, std::size_t k);
  /// A register with the unsigned value of operand k, to be overwritten.
  std::uint8_t start_from(const std::vector<Operand>& operands, std::size_t k);
  /// Frees the values of operands that nothing later needs.
  void drop(const std::vector<Operand>& operands);

  FunctionSteps& written() { return written_; }

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> uses() const;
  Location mode_value(const Operand& operand);

  const program::Function& function_;
  Constants& constants_;
  std::span<const double> default_inputs_;
  bool takes_inputs_;
  std::vector<double> numbers_;  // of function_.constants
  std::vector<std::optional<double>> constant_;
  std::vector<bool> absorbed_;  // arctangents that their only user computes
  FunctionSteps written_;
  std::optional<Registers> registers_;
  std::map<std::pair<Slot, std::uint32_t>, std::uint32_t> mode_values_;
};

}  // namespace eomgen::jit
