// SPDX-License-Identifier: GPL-3.0-or-later
// The Kepler orbit from its perihelion, by Kepler's equation; its plane is rotated about E1 by the inclination.
#pragma once

#include <array>
#include <cmath>

namespace eomgen::test {

struct Orbit {
  std::array<double, 3> r, v;
};

inline Orbit kepler(double GM, double a, double e, double inclination, double t) {
  const double n = std::sqrt(GM / (a * a * a)), mean = n * t;
  double E = mean + e * std::sin(mean);
  for (int i = 0; i < 60; ++i) E -= (E - e * std::sin(E) - mean) / (1 - e * std::cos(E));
  const double rate = n / (1 - e * std::cos(E)), minor = a * std::sqrt(1 - e * e);
  const double X = a * (std::cos(E) - e), Y = minor * std::sin(E);
  const double Xdot = -a * std::sin(E) * rate, Ydot = minor * std::cos(E) * rate;
  const double c = std::cos(inclination), s = std::sin(inclination);
  return {{X, Y * c, Y * s}, {Xdot, Ydot * c, Ydot * s}};
}

}  // namespace eomgen::test
