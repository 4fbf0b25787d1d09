// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/mman.h>

#include <cstring>
#include <stdexcept>

#include "error.hpp"
#include "jit/encode.hpp"

namespace eomgen::jit {

ExecutableMemory::ExecutableMemory(const unsigned char* code, std::size_t size) : size_(size) {
  const auto fail = [](const char* what) {
    throw Error("run", {}, what, "--tier compiled uses the C compiler", ErrorKind::tool);
  };
  void* const memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) fail("there is no memory for machine code");
  std::memcpy(memory, code, size);
  if (::mprotect(memory, size, PROT_READ | PROT_EXEC) != 0) {
    ::munmap(memory, size);
    fail("this system lets no memory become executable");
  }
  start_ = memory;
}

ExecutableMemory::~ExecutableMemory() { ::munmap(start_, size_); }

const void* ExecutableMemory::at(std::size_t offset) const {
  if (offset >= size_) throw std::logic_error("a function is outside its memory");
  return static_cast<const unsigned char*>(start_) + offset;
}

}  // namespace eomgen::jit
