// SPDX-License-Identifier: GPL-3.0-or-later
#include "handwritten.hpp"

#include <cfloat>
#include <cmath>
#include <cstring>

#include "handwritten_chain.hpp"
#include "sincos_kernel.hpp"

namespace eomgen::bench {
namespace {

struct Packed {
  template <int N>
  [[gnu::always_inline]] static bool sincos(const double* angle, double* s, double* c) {
    bench_lanes reach = {0};
#pragma GCC unroll 32
    for (int i = 0; i < N; i += 2) bench_sincos_near(angle[i], angle[i + 1], s + i, c + i, &reach);
    return bench_is_near(&reach);
  }
};
constexpr int room(int n) { return n + n % 2; }

template <int N>
[[gnu::always_inline]] inline void copy_rates(const double* x, double* dx) {
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) dx[i] = x[N + i];
}

template <int N, class Sines>
int dense(double, const double* x, const double* p, const double*, int, double* dx) {
  handwritten_chain<N, Sines>(x, p[1], p[2], dx);
  return 0;
}

/// s0, c0: of the first angle; s, c: of th_i - th_i-1 for i >= 1.
template <int N>
[[gnu::always_inline]] inline void from_tensions(const double* x, double gL, double s0, double c0, const double* s, const double* c, double* dx) {
  double w2[N], k[N], f[N];  // k_i = f_i + b_i k_i-1 from the last rod to the first
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) w2[i] = x[N + i] * x[N + i];
  if constexpr (N == 1) {
    dx[1] = -gL * s0;
  } else {
    double b[N];
    b[N - 1] = 0.5 * c[N - 1];
    f[N - 1] = 0.5 * w2[N - 1];
#pragma GCC unroll 32
    for (int i = N - 2; i > 0; --i) {
      const double inverse = 1 / (2 - c[i + 1] * b[i + 1]);
      f[i] = (w2[i] + c[i + 1] * f[i + 1]) * inverse;
      b[i] = c[i] * inverse;
    }
    k[0] = (w2[0] + gL * c0 + c[1] * f[1]) / (1 - c[1] * b[1]);
#pragma GCC unroll 32
    for (int i = 1; i < N; ++i) k[i] = f[i] + b[i] * k[i - 1];
    dx[N] = k[1] * s[1] - gL * s0;
#pragma GCC unroll 32
    for (int i = 1; i < N - 1; ++i) dx[N + i] = k[i + 1] * s[i + 1] - k[i - 1] * s[i];
    dx[2 * N - 1] = -k[N - 2] * s[N - 1];
  }
  copy_rates<N>(x, dx);
}

template <int N, class Sines>
int tensions(double t, const double* x, const double* p, const double* u, int mode, double* dx) {
  double angle[room(N)] = {}, s[room(N)], c[room(N)], ds[N], dc[N];
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) angle[i] = x[i];
  if (!Sines::template sincos<N>(angle, s, c)) return tensions<N, Library>(t, x, p, u, mode, dx);
#pragma GCC unroll 32
  for (int i = 1; i < N; ++i) {
    ds[i] = s[i] * c[i - 1] - c[i] * s[i - 1];
    dc[i] = c[i] * c[i - 1] + s[i] * s[i - 1];
  }
  from_tensions<N>(x, p[2] / p[1], s[0], c[0], ds, dc, dx);
  return 0;
}

template <int N, class Sines>
int differences(double t, const double* x, const double* p, const double* u, int mode, double* dx) {
  double angle[room(N)] = {}, s[room(N)], c[room(N)];
  angle[0] = x[0];
#pragma GCC unroll 32
  for (int i = 1; i < N; ++i) angle[i] = x[i] - x[i - 1];
  if (!Sines::template sincos<N>(angle, s, c)) return differences<N, Library>(t, x, p, u, mode, dx);
  from_tensions<N>(x, p[2] / p[1], s[0], c[0], s, c, dx);
  return 0;
}

}  // namespace

template <int N>
const Handwritten (&handwritten())[variants] {
  static const Handwritten list[variants] = {{"dense, libm", dense<N, Library>},
                                             {"dense, packed", dense<N, Packed>},
                                             {"tensions, libm", tensions<N, Library>},
                                             {"tensions, packed", tensions<N, Packed>},
                                             {"differences, libm", differences<N, Library>},
                                             {"differences, packed", differences<N, Packed>}};
  return list;
}
template const Handwritten (&handwritten<1>())[variants];
template const Handwritten (&handwritten<2>())[variants];
template const Handwritten (&handwritten<3>())[variants];
template const Handwritten (&handwritten<6>())[variants];
template const Handwritten (&handwritten<10>())[variants];

}  // namespace eomgen::bench
