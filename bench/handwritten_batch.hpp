// SPDX-License-Identifier: GPL-3.0-or-later
// The chain of handwritten.hpp for as many states at once as a register holds, handwritten. Entry i of state s is at
// [i*stride + s]; all parameters are equal; `count` is a multiple of the lanes; no checks and no codes.
#pragma once

#include <cstddef>

namespace eomgen::bench {

using BatchByHand = void (*)(std::size_t count, std::size_t stride, const double* x, const double* p, double* dx);

struct HandwrittenBatch {
  const char* name;
  BatchByHand rhs;
};
constexpr int batch_variants = 2;
/// For N links: 2, 6, 10, 20 or 30.
template <int N>
const HandwrittenBatch (&handwritten_batch())[batch_variants];

int handwritten_lanes();

}  // namespace eomgen::bench
