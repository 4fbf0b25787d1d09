// SPDX-License-Identifier: GPL-3.0-or-later
#include "handwritten.hpp"

#include <cfloat>
#include <cmath>
#include <cstring>

#include "handwritten_chain.hpp"
#include "handwritten_tensions.hpp"
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

template <int N, class Sines>
int dense(double, const double* x, const double* p, const double*, const int*, double* dx) {
  handwritten_chain<N, Sines>(x, p[1], p[2], dx);
  return 0;
}

template <int N, class Sines>
int tensions(double t, const double* x, const double* p, const double* u, const int* mode, double* dx) {
  double angle[room(N)] = {}, s[room(N)], c[room(N)], ds[N], dc[N];
#pragma GCC unroll 32
  for (int i = 0; i < N; ++i) angle[i] = x[i];
  if (!Sines::template sincos<N>(angle, s, c)) return tensions<N, Library>(t, x, p, u, mode, dx);
#pragma GCC unroll 32
  for (int i = 1; i < N; ++i) {
    ds[i] = s[i] * c[i - 1] - c[i] * s[i - 1];
    dc[i] = c[i] * c[i - 1] + s[i] * s[i - 1];
  }
  from_tensions<N, double>(x, p[2] / p[1], s[0], c[0], ds, dc, dx);
  return 0;
}

template <int N, class Sines>
int differences(double t, const double* x, const double* p, const double* u, const int* mode, double* dx) {
  double angle[room(N)] = {}, s[room(N)], c[room(N)];
  angle[0] = x[0];
#pragma GCC unroll 32
  for (int i = 1; i < N; ++i) angle[i] = x[i] - x[i - 1];
  if (!Sines::template sincos<N>(angle, s, c)) return differences<N, Library>(t, x, p, u, mode, dx);
  from_tensions<N, double>(x, p[2] / p[1], s[0], c[0], s, c, dx);
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
template const Handwritten (&handwritten<20>())[variants];
template const Handwritten (&handwritten<30>())[variants];

}  // namespace eomgen::bench
