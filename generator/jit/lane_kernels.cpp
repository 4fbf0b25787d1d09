// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for AVX2: called by the code of lanes alone, which needs it. No inline function of a library is used here,
// because the linker could take its copy for other processors too.
#include <cstring>

#include "jit/kernels.hpp"

namespace eomgen::jit {
namespace {

typedef double kernel_lanes __attribute__((vector_size(32)));
typedef unsigned long long kernel_bits __attribute__((vector_size(32)));

#include "skeletons/sincos_lanes.inc"

void wide_group(double* angles, std::size_t count) {
  double* const sine = angles + count;
  double* const cosine = angles + 2 * count;
  kernel_lanes reach = {0};
  for (std::size_t i = 0; i < count; i += 4) {
    kernel_lanes angle, size, s, c;
    std::memcpy(&angle, angles + i, sizeof angle);
    kernel_sincos_lanes(&angle, &size, &s, &c);
    reach += size;
    std::memcpy(sine + i, &s, sizeof s);
    std::memcpy(cosine + i, &c, sizeof c);
  }
  // Beyond the range of the polynomials, each angle decides alone.
  if (!(reach[0] + reach[1] + reach[2] + reach[3] <= 65536.0)) sincos_group()(angles, count);
}

}  // namespace

SincosGroup wide_sincos_group() { return wide_group; }

}  // namespace eomgen::jit
