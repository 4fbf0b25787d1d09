// SPDX-License-Identifier: GPL-3.0-or-later
#include "handwritten_batch.hpp"

#include <cstring>

#include "handwritten_tensions.hpp"

namespace {

#if defined(__AVX512F__)
constexpr int lanes = 8;
#elif defined(__AVX__)
constexpr int lanes = 4;
#else
constexpr int lanes = 2;
#endif
using wide_lanes = double __attribute__((vector_size(8 * lanes)));
using wide_bits = unsigned long long __attribute__((vector_size(8 * lanes)));
using wide_memory = double __attribute__((vector_size(8 * lanes), aligned(8), may_alias));

#include "sincos_wide.hpp"

}  // namespace

namespace eomgen::bench {
namespace {

template <int N, bool of_differences>
void chain(std::size_t count, std::size_t stride, const double* from, const double* p, double* to) {
  const wide_lanes gL = wide_lanes{} + p[2] / p[1];
  for (std::size_t first = 0; first < count; first += lanes) {
    wide_lanes x[2 * N], dx[2 * N], s[N], c[N], size;
#pragma GCC unroll 64
    for (int i = 0; i < 2 * N; ++i)
      x[i] = *reinterpret_cast<const wide_memory*>(from + static_cast<std::size_t>(i) * stride + first);
#pragma GCC unroll 32
    for (int i = 0; i < N; ++i) {
      const wide_lanes angle = of_differences && i > 0 ? x[i] - x[i - 1] : x[i];
      wide_sincos_lanes(&angle, &size, &s[i], &c[i]);
    }
    if constexpr (of_differences) {
      from_tensions<N, wide_lanes>(x, gL, s[0], c[0], s, c, dx);
    } else {
      wide_lanes ds[N], dc[N];
#pragma GCC unroll 32
      for (int i = 1; i < N; ++i) {
        ds[i] = s[i] * c[i - 1] - c[i] * s[i - 1];
        dc[i] = c[i] * c[i - 1] + s[i] * s[i - 1];
      }
      from_tensions<N, wide_lanes>(x, gL, s[0], c[0], ds, dc, dx);
    }
#pragma GCC unroll 64
    for (int i = 0; i < 2 * N; ++i)
      *reinterpret_cast<wide_memory*>(to + static_cast<std::size_t>(i) * stride + first) =
          static_cast<wide_memory>(dx[i]);
  }
}

}  // namespace

template <int N>
const HandwrittenBatch (&handwritten_batch())[batch_variants] {
  static const HandwrittenBatch list[batch_variants] = {{"tensions", chain<N, false>}, {"differences", chain<N, true>}};
  return list;
}
template const HandwrittenBatch (&handwritten_batch<2>())[batch_variants];
template const HandwrittenBatch (&handwritten_batch<6>())[batch_variants];
template const HandwrittenBatch (&handwritten_batch<10>())[batch_variants];
template const HandwrittenBatch (&handwritten_batch<20>())[batch_variants];
template const HandwrittenBatch (&handwritten_batch<30>())[batch_variants];

int handwritten_lanes() { return lanes; }

}  // namespace eomgen::bench
