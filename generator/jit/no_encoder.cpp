// SPDX-License-Identifier: GPL-3.0-or-later
// Builds for other processors, or without asmjit.
#include "jit/encode.hpp"
#include "jit/lane_encode.hpp"

namespace eomgen::jit {

struct Encoder::Assembly {};

Encoder::Encoder() = default;
Encoder::~Encoder() = default;
FunctionNumber Encoder::function(const FunctionSteps&, const double*, const double*) { return 0; }
FunctionNumber Encoder::choice(const std::vector<abi::Input>&, std::size_t, const std::vector<ChartCase>&, bool) {
  return 0;
}
FunctionNumber Encoder::with_context(const void*, const void*, const std::vector<abi::Input>&, std::size_t) {
  return 0;
}
Encoder::Finished Encoder::finish() { return {}; }

const char* encoder_refusal() { return EOMGEN_NO_ENCODER; }

bool has_lanes() { return false; }
std::unique_ptr<ExecutableMemory> encode_lanes(const FunctionSteps&, const double*) { return nullptr; }

}  // namespace eomgen::jit
