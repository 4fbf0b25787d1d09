// SPDX-License-Identifier: GPL-3.0-or-later
// The right-hand side of a planar chain of N equal point masses m on massless rods of length L, absolute angles from
// the downward vertical, handwritten by a specialist: composite masses, each sine and cosine once, the differences of
// angles from products, an unrolled LDL^T, libm. Emitted code is compared with it.
//   sum_j mu_ij (cos(th_i - th_j) w_j' + sin(th_i - th_j) w_j^2) = -(N - i) (g/L) sin th_i,  mu_ij = N - max(i, j)
#pragma once

#include <array>
#include <cmath>

namespace eomgen::bench {

/// Sines and cosines of the C library; the arrays have an even length. False: to be repeated with `Library`.
struct Library {
  template <int N>
  [[gnu::always_inline]] static bool sincos(const double* angle, double* s, double* c) {
#pragma GCC unroll 32
    for (int i = 0; i < N; ++i) {
      s[i] = std::sin(angle[i]);
      c[i] = std::cos(angle[i]);
    }
    return true;
  }
};

template <int N, class Sines = Library>
inline void handwritten_chain(const double* x, double L, double g, double* dx) {
  constexpr int room = N + N % 2;
  double angle[room] = {}, s[room], c[room], w2[N], M[N][N], r[N];
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) angle[i] = x[i];
  if (!Sines::template sincos<N>(angle, s, c)) return handwritten_chain<N>(x, L, g, dx);
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) {
    dx[i] = x[N + i];
    w2[i] = x[N + i] * x[N + i];
  }
  const double gL = g / L;
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) r[i] = -(N - i) * gL * s[i];
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) {
    M[i][i] = N - i;
#pragma GCC unroll 32
    for (int j = 0; j < i; ++j) {
      const double mu = N - i;
      M[i][j] = mu * (c[i] * c[j] + s[i] * s[j]);
      const double k = mu * (s[i] * c[j] - c[i] * s[j]);
      r[i] -= k * w2[j];
      r[j] += k * w2[i];
    }
  }
  double d[N];
#pragma GCC unroll 32
  for (int j = 0; j < N; ++j) {
    double v[N];
    d[j] = M[j][j];
#pragma GCC unroll 32
    for (int k = 0; k < j; ++k) {
      v[k] = M[j][k] * d[k];
      d[j] -= M[j][k] * v[k];
    }
    const double inverse = 1 / d[j];
#pragma GCC unroll 32
    for (int i = j + 1; i < N; ++i) {
#pragma GCC unroll 32
      for (int k = 0; k < j; ++k) M[i][j] -= M[i][k] * v[k];
      M[i][j] *= inverse;
    }
  }
#pragma GCC unroll 32
  for (int i = 1; i < N; ++i) {
#pragma GCC unroll 32
    for (int k = 0; k < i; ++k) r[i] -= M[i][k] * r[k];
  }
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) r[i] /= d[i];
#pragma GCC unroll 32
  for (int i = N - 2; i >= 0; --i) {
#pragma GCC unroll 32
    for (int k = i + 1; k < N; ++k) r[i] -= M[k][i] * r[k];
  }
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) dx[N + i] = r[i];
}

}  // namespace eomgen::bench
