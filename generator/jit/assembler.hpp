// SPDX-License-Identifier: GPL-3.0-or-later
// What the encoders of one state and of lanes share of asmjit.
#pragma once

#include <asmjit/x86.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "jit/encode.hpp"

namespace eomgen::jit {

/// Errors of the assembler are defects of the encoders.
class AssemblyFailure : public asmjit::ErrorHandler {
 public:
  void handleError(asmjit::Error, const char* message, asmjit::BaseEmitter*) override {
    throw std::logic_error(std::string("assembler: ") + message);
  }
};

inline void require(asmjit::Error error) {
  if (error != asmjit::kErrorOk)
    throw std::logic_error(std::string("assembler: ") + asmjit::DebugUtils::errorAsString(error));
}

/// The offset of an element of an array of elements of `size` bytes.
inline std::int32_t array_offset(std::size_t index, std::size_t size) {
  const std::size_t limit = 0x7fffffff / size - 16;
  if (index > limit) throw std::logic_error("an array is too long for machine code");
  return static_cast<std::int32_t>(index * size);
}

/// Touches a large frame page by page, so that it cannot step over the guard page.
inline void make_frame(asmjit::x86::Assembler& to, std::int32_t bytes) {
  namespace x86 = asmjit::x86;
  constexpr std::int32_t page = 4096;
  for (; bytes > page; bytes -= page) {
    to.sub(x86::rsp, page);
    to.or_(x86::dword_ptr(x86::rsp), 0);
  }
  to.sub(x86::rsp, bytes);
}

/// Binds a label to `count` equal numbers.
template <std::size_t count>
void embed_numbers(asmjit::x86::Assembler& to, const asmjit::Label& label, std::uint64_t bits) {
  std::array<std::uint64_t, count> numbers;
  numbers.fill(bits);
  to.align(asmjit::AlignMode::kData, static_cast<std::uint32_t>(sizeof numbers));
  to.bind(label);
  to.embed(numbers.data(), sizeof numbers);
}

/// The memory with the complete code.
std::unique_ptr<ExecutableMemory> executable(asmjit::CodeHolder& code);

}  // namespace eomgen::jit
