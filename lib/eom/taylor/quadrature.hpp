// SPDX-License-Identifier: MIT
// Gauss-Legendre quadrature on [0, 1] with eight nodes, of degree 15. Nodes and weights are computed once from the
// Legendre polynomial by Newton's iteration.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace eom::taylor {

struct Gauss {
  static constexpr std::size_t count = 8;
  std::array<double, count> node{}, weight{};

  Gauss() {
    for (std::size_t i = 0; i < count; ++i) {
      long double x = std::cos(std::numbers::pi_v<long double> * (static_cast<long double>(i) + 0.75L) /
                               (count + 0.5L)),
                  slope = 1;
      for (int k = 0; k < 8; ++k) {
        long double before = 1, here = x;
        for (std::size_t n = 2; n <= count; ++n) {
          const long double order = static_cast<long double>(n);
          const long double next = ((2 * order - 1) * x * here - (order - 1) * before) / order;
          before = here;
          here = next;
        }
        slope = count * (x * here - before) / (x * x - 1);
        x -= here / slope;
      }
      node[i] = static_cast<double>((1 + x) / 2);
      weight[i] = static_cast<double>(1 / ((1 - x * x) * slope * slope));
    }
  }
};

}  // namespace eom::taylor
