// SPDX-License-Identifier: GPL-3.0-or-later
// In: a program. Out: its functions as machine code in the memory of this process, without a compiler: the functions of
// the C ABI (docs/abi.md), with the bits that the emitted C has, compiled without fused multiplications.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "abi/compiled.hpp"
#include "program/program.hpp"

namespace eomgen::jit {

/// Why this build generates no machine code; empty if it does.
std::string refusal();

/// Machine code of a program. The functions may be called from any thread while this object exists.
class MachineCode : public abi::CompiledFunctions {
 public:
  /// `default_inputs`: values of the inputs that are not given. Throws Error{ErrorKind::tool} if this build or this
  /// system has no machine code.
  MachineCode(const program::Program& program, std::span<const double> default_inputs);
  ~MachineCode();
  MachineCode(MachineCode&& other) noexcept;
  MachineCode& operator=(MachineCode&& other) noexcept;

  std::size_t bytes() const;

 private:
  friend class Generation;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace eomgen::jit
