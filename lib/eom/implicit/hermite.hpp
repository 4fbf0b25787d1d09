// SPDX-License-Identifier: MIT
// The cubic Hermite polynomial of a step: dense output of methods without a better one.
#pragma once

#include <cstddef>

namespace eom::implicit {

/// x at the fraction s of a step h, n components; x0, f0 and x1, f1: states and derivatives at its ends.
inline void hermite(double s, double h, std::size_t n, const double* x0, const double* f0, const double* x1,
                    const double* f1, double* x) {
  for (std::size_t i = 0; i < n; ++i) {
    const double d1 = x1[i] - x0[i], d2 = h * f0[i] - d1, d3 = d1 - h * f1[i] - d2;
    x[i] = x0[i] + s * (d1 + (1 - s) * (d2 + s * d3));
  }
}

}  // namespace eom::implicit
