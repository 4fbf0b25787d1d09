// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of mutated models for some steps, linearisations, equilibria, inverse dynamics. Code is compiled without
// optimisation by tests/fuzz/cc.
#include <cstdlib>

#include "commands.hpp"

namespace fuzz = eomgen::fuzz;

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  setenv("EOMGEN_CC", EOMGEN_FUZZ_CC, 1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::try_command(fuzz::run_calls(), {reinterpret_cast<const char*>(data), size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  return fuzz::mutate_bytes(fuzz::run_calls(), data, size, most, seed);
}
