// SPDX-License-Identifier: GPL-3.0-or-later
// Common part of `tensions` and `differences` of handwritten.hpp, over double or a vector of doubles.
#pragma once

namespace eomgen::bench {

template <int N, class Real>
[[gnu::always_inline]] inline void copy_rates(const Real* x, Real* dx) {
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) dx[i] = x[N + i];
}

/// s0, c0: of the first angle; s, c: of th_i - th_i-1 for i >= 1.
template <int N, class Real>
[[gnu::always_inline]] inline void from_tensions(const Real* x, Real gL, Real s0, Real c0, const Real* s, const Real* c,
                                                 Real* dx) {
  Real w2[N], k[N], f[N];  // k_i = f_i + b_i k_i-1 from the last rod to the first
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) w2[i] = x[N + i] * x[N + i];
  if constexpr (N == 1) {
    dx[1] = -gL * s0;
  } else {
    Real b[N];
    b[N - 1] = 0.5 * c[N - 1];
    f[N - 1] = 0.5 * w2[N - 1];
#pragma GCC unroll 32
    for (int i = N - 2; i > 0; --i) {
      const Real inverse = 1.0 / (2.0 - c[i + 1] * b[i + 1]);
      f[i] = (w2[i] + c[i + 1] * f[i + 1]) * inverse;
      b[i] = c[i] * inverse;
    }
    k[0] = (w2[0] + gL * c0 + c[1] * f[1]) / (1.0 - c[1] * b[1]);
#pragma GCC unroll 32
    for (int i = 1; i < N; ++i) k[i] = f[i] + b[i] * k[i - 1];
    dx[N] = k[1] * s[1] - gL * s0;
#pragma GCC unroll 32
    for (int i = 1; i < N - 1; ++i) dx[N + i] = k[i + 1] * s[i + 1] - k[i - 1] * s[i];
    dx[2 * N - 1] = -k[N - 2] * s[N - 1];
  }
  copy_rates<N, Real>(x, dx);
}

}  // namespace eomgen::bench
