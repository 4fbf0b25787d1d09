// SPDX-License-Identifier: GPL-3.0-or-later
// In: the steps of a function. Out: machine code that takes them for four states at once, in the vector registers of
// AVX, with the bits that one state alone has.
#pragma once

#include <cstddef>
#include <memory>

#include "jit/encode.hpp"

namespace eomgen::jit {

inline constexpr std::size_t lane_width = 4;

/// Arguments of such a function. Value k of lane s is at 4 k + s. Values that the states share are there four times.
struct LaneArguments {
  const double *t = nullptr, *state = nullptr, *parameters = nullptr, *prepared = nullptr, *inputs = nullptr;
  double* result = nullptr;
};

/// Returns 0, or another number if a test of some lane fails or a result is not finite: then the results mean nothing.
using LaneFunction = int (*)(const LaneArguments*);

/// Whether this build and this processor have the registers.
bool has_lanes();

/// The function at offset 0. `constants`, each four times, must outlive the code. Requires has_lanes(), and a function
/// with one result. Entries of `mode` are 0.
std::unique_ptr<ExecutableMemory> encode_lanes(const FunctionSteps& steps, const double* constants);

}  // namespace eomgen::jit
