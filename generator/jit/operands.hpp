// SPDX-License-Identifier: GPL-3.0-or-later
// The operands of a function while its steps are written: where their values are, and how long they are needed.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "jit/registers.hpp"
#include "program/program.hpp"

namespace eomgen::jit {

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
