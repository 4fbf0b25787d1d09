// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-built models for several tests of verify.
#pragma once

#include "verify/model_builder.hpp"

namespace eomgen::verify::test {

inline ModelFormula spherical(ModelFormula R, ModelFormula phi, ModelFormula theta) {
  return vector(R * sin(phi) * cos(theta), R * sin(phi) * sin(theta), R * cos(phi));
}

/// P7 and P1: a particle on a sphere of radius d(t) = d0 + a sin(w t) under gravity, with the force D R e_theta.
/// Parameters m, g, D, d0, a, w; coordinates R, phi, theta.
inline model::Model moving_sphere() {
  model::Model m;
  m.id = "moving_sphere";
  const ModelFormula mass = parameter(m, "m", 1), g = parameter(m, "g", Rational(981) / 100);
  const ModelFormula D = parameter(m, "D", Rational(3) / 10), d0 = parameter(m, "d0", 1);
  const ModelFormula a = parameter(m, "a", Rational(1) / 10), w = parameter(m, "w", 2);
  const ModelFormula d = function(m, "d", d0 + a * sin(w * time(m)));
  const ModelFormula R = coordinate(m, "R"), phi = coordinate(m, "phi"), theta = coordinate(m, "theta");
  m.coordinates[0].lower = m.coordinates[1].lower = number(m, 0).id;
  m.coordinates[1].upper = leaf(m, Op::pi, 0).id;
  const ModelFormula P = place(m, "P", spherical(R, phi, theta), mass);
  gravity(m, -(g * E(m, 3)));
  applied(m, D * R * basis(Op::unit_basis, P, theta), P);
  holonomic(m, "sphere", {R - d});
  default_scene(m);
  return m;
}

/// A cart (M, pulled by F against c x_dot) with a pendulum (m, l), from its energies.
/// Parameters M, m, l, g, c; coordinates x, theta.
inline model::Model cart_pendulum() {
  model::Model m;
  m.id = "cart_pendulum";
  const ModelFormula M = parameter(m, "M", 2), mass = parameter(m, "m", Rational(1) / 2);
  const ModelFormula l = parameter(m, "l", Rational(4) / 5), g = parameter(m, "g", Rational(981) / 100);
  const ModelFormula c = parameter(m, "c", Rational(1) / 10);
  const ModelFormula F = input(m, "F");
  const ModelFormula x = coordinate(m, "x"), theta = coordinate(m, "theta");
  const ModelFormula x_dot = rate(x), theta_dot = rate(theta);
  m.energy.kinetic =
      ((M + mass) / 2 * (x_dot ^ 2) + mass * l * x_dot * theta_dot * cos(theta) + mass * (l ^ 2) / 2 * (theta_dot ^ 2))
          .id;
  m.energy.potential = (-(mass * g * l * cos(theta))).id;
  generalized(m, 0, F - c * x_dot);
  default_scene(m);
  return m;
}

/// A planar chain of n masses, absolute angles from the vertical; parameters m1, l1, m2, l2, ..., g.
inline model::Model chain(int n) {
  model::Model m;
  m.id = "chain";
  ModelFormula position{};
  for (int i = 1; i <= n; ++i) {
    const ModelFormula mass = parameter(m, "m" + std::to_string(i), i),
                       l = parameter(m, "l" + std::to_string(i), Rational(1) / i);
    const ModelFormula angle = coordinate(m, "th" + std::to_string(i));
    const ModelFormula rod = vector(l * sin(angle), -(l * cos(angle)), number(m, 0));
    position = place(m, "P" + std::to_string(i), i == 1 ? rod : position + rod, mass);
  }
  const ModelFormula g = parameter(m, "g", Rational(981) / 100);
  gravity(m, -(g * E(m, 2)));
  default_scene(m);
  return m;
}

/// A planar pendulum in x, y on a rod whose length constraint keeps its multiplier, with a spring and a damper to a
/// point. Parameters m, g, L, k, c.
inline model::Model rod_pendulum() {
  model::Model m;
  m.id = "rod_pendulum";
  const ModelFormula mass = parameter(m, "m", 2), g = parameter(m, "g", Rational(981) / 100), L = parameter(m, "L", 1);
  const ModelFormula k = parameter(m, "k", 5), c = parameter(m, "c", Rational(1) / 2);
  const ModelFormula x = coordinate(m, "x"), y = coordinate(m, "y");
  const ModelFormula P = place(m, "P", vector(x, y, number(m, 0)), mass);
  const ModelFormula A = place(m, "A", vector(number(m, 2), number(m, 1), number(m, 0)));
  gravity(m, -(g * E(m, 2)));
  spring(m, A, P, k, number(m, Rational(3) / 2));
  damper(m, A, P, c);
  holonomic(m, "rod", {(x ^ 2) + (y ^ 2) - (L ^ 2)});
  m.scenes.clear();
  default_scene(m);
  model::InitialValue start{1, 0, number(m, -1).id, {}};
  m.scenes[0].initial.push_back(start);
  return m;
}

}  // namespace eomgen::verify::test
