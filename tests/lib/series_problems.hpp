// Problems of problems.hpp with their Taylor series by handwritten recurrences. In: nothing. Out: right-hand sides for
// `taylor`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lib/problems.hpp"

namespace problems {

inline constexpr int hand_order = 40;
using Terms = std::array<double, hand_order + 1>;

inline double convolution(const Terms& a, const Terms& b, int k) {
  double sum = 0;
  for (int j = 0; j <= k; ++j) sum += a[static_cast<std::size_t>(j)] * b[static_cast<std::size_t>(k - j)];
  return sum;
}

/// theta_k+1 = omega_k/(k+1), omega_k+1 = -(sin theta)_k/(k+1).
struct PendulumSeries : Pendulum {
  using Pendulum::Pendulum;
  int taylor_order() const { return hand_order; }
  std::size_t taylor_states() const { return 2; }
  int taylor(double, const double* x, int order, double* out) const {
    Terms s{std::sin(x[0])}, c{std::cos(x[0])}, slope{};
    out[0] = x[0];
    out[1] = x[1];
    for (std::size_t k = 0; k < static_cast<std::size_t>(order); ++k) {
      const double n = static_cast<double>(k) + 1;
      out[2 * k + 2] = out[2 * k + 1] / n;
      out[2 * k + 3] = -s[k] / n;
      slope[k] = out[2 * k + 1];  // of theta
      s[k + 1] = convolution(slope, c, static_cast<int>(k)) / n;
      c[k + 1] = -convolution(slope, s, static_cast<int>(k)) / n;
    }
    return 0;
  }
};

/// u = (x^2 + y^2)^(-3/2) by k r_0 u_k = sum of (-3/2 j - (k - j)) r_j u_(k-j).
struct KeplerSeries : Kepler {
  using Kepler::Kepler;
  int taylor_order() const { return hand_order; }
  std::size_t taylor_states() const { return 4; }
  int taylor(double, const double* start_at, int order, double* out) const {
    Terms x{}, y{}, r{}, u{};
    std::copy_n(start_at, 4, out);
    for (std::size_t k = 0; k < static_cast<std::size_t>(order); ++k) {
      const int at = static_cast<int>(k);
      x[k] = out[4 * k];
      y[k] = out[4 * k + 1];
      r[k] = convolution(x, x, at) + convolution(y, y, at);
      double sum = k == 0 ? std::pow(r[0], -1.5) : 0;
      for (std::size_t j = 1; j <= k; ++j)
        sum += (-1.5 * static_cast<double>(j) - static_cast<double>(k - j)) * r[j] * u[k - j] /
               (static_cast<double>(k) * r[0]);
      u[k] = sum;
      const double n = static_cast<double>(k) + 1;
      out[4 * k + 4] = out[4 * k + 2] / n;
      out[4 * k + 5] = out[4 * k + 3] / n;
      out[4 * k + 6] = -convolution(x, u, at) / n;
      out[4 * k + 7] = -convolution(y, u, at) / n;
    }
    return 0;
  }
};

}  // namespace problems
