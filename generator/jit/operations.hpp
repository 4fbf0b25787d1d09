// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of instructions, with the operations, their order and the roundings of the emitted C
// (emit/expressions.hpp).
#pragma once

#include "jit/operands.hpp"

namespace eomgen::jit {

class Operations : public Operands {
 public:
  using Operands::Operands;

  /// Writes the steps of an instruction; those of a group of sines and cosines with its first one.
  void instruction(std::uint32_t i);

 private:
  std::optional<std::uint8_t> computed(const program::Instruction& instruction);
  std::vector<Operand> with_best_first(const std::vector<Operand>& operands);
  std::uint8_t sum(const std::vector<Operand>& operands);
  std::uint8_t product(const std::vector<Operand>& operands);
  std::uint8_t quotient(const std::vector<Operand>& o);
  std::uint8_t root(const std::vector<Operand>& o);
  std::uint8_t extreme(symbolic::Op op, const std::vector<Operand>& o);
  std::uint8_t selected(const std::vector<Operand>& o);
  std::uint8_t of_arctangent(symbolic::Op op, const Operand& argument);
  std::optional<std::uint8_t> small_power(const std::vector<Operand>& o);
  std::uint8_t library_call(symbolic::Op op, const std::vector<Operand>& o);
  Location in_memory(const Operand& operand);
  void sincos_group(std::uint32_t first);
};

}  // namespace eomgen::jit
