// SPDX-License-Identifier: GPL-3.0-or-later
// Derivations of mutated models: classify, show, verify, emit.
#include "commands.hpp"

namespace fuzz = eomgen::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::try_command(fuzz::derive_calls(), {reinterpret_cast<const char*>(data), size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  return fuzz::mutate_bytes(fuzz::derive_calls(), data, size, most, seed);
}
