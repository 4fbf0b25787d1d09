// SPDX-License-Identifier: GPL-3.0-or-later
// Jacobi's elliptic functions by the arithmetic-geometric mean (Abramowitz & Stegun 16.4), for closed forms of
// pendulums.
#pragma once

#include <cmath>

namespace eomgen::test {

struct Jacobi {
  double sn, cn, dn;
};

/// Modulus k in [0, 1).
inline Jacobi jacobi(double u, double k) {
  double a[32], c[32], b = std::sqrt(1 - k * k);
  a[0] = 1;
  c[0] = k;
  int n = 0;
  while (std::abs(c[n]) > 1e-17 && n < 30) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1 - k * k * sn * sn)};
}

struct Swing {
  double angle, rate;
};

/// A pendulum of frequency w = sqrt(g/L) let go at rest from `amplitude`: sin(angle/2) = k cd(w t, k).
inline Swing pendulum_from_rest(double amplitude, double w, double t) {
  const double k = std::sin(amplitude / 2);
  const Jacobi j = jacobi(w * t, k);
  const double cd = j.cn / j.dn;
  const double angle = 2 * std::asin(k * cd);
  // d cd/du = -(1 - k^2) sn/dn^2
  const double rate = 2 * k * w * (-(1 - k * k) * j.sn / (j.dn * j.dn)) / std::sqrt(1 - k * k * cd * cd);
  return {angle, rate};
}

}  // namespace eomgen::test
