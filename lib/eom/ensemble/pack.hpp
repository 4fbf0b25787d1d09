// SPDX-License-Identifier: MIT
// A pack of doubles as wide as a register, if the compiler has vector types (GCC, Clang); else one double. Each element
// is bitwise equal to a scalar computation.
#pragma once

#include <cstddef>

namespace eom::ensemble {

#if !defined(__GNUC__)
inline constexpr std::size_t pack_width = 1;
using Pack = double;
using PackInMemory = double;
#else
#if defined(__AVX512F__)
inline constexpr std::size_t pack_width = 8;
#elif defined(__AVX__)
inline constexpr std::size_t pack_width = 4;
#else
inline constexpr std::size_t pack_width = 2;
#endif
using Pack = double __attribute__((vector_size(8 * pack_width)));
// A typedef, because clang ignores `aligned` in alias declarations.
typedef double PackInMemory __attribute__((vector_size(8 * pack_width), aligned(8), may_alias));
#endif

[[gnu::always_inline]] inline Pack load(const double* at) { return *reinterpret_cast<const PackInMemory*>(at); }
[[gnu::always_inline]] inline void store(double* at, Pack a) { *reinterpret_cast<PackInMemory*>(at) = a; }

/// std::max, also for NaN.
[[gnu::always_inline]] inline Pack larger(Pack a, Pack b) { return a < b ? b : a; }
[[gnu::always_inline]] inline Pack size_of(Pack a) {
  const Pack zero{};
  return a < zero ? -a : a + zero;  // -0 + 0 is 0
}

}  // namespace eom::ensemble
