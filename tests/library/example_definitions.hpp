// SPDX-License-Identifier: GPL-3.0-or-later
// Example models built in code.
#pragma once

#include "eomgen/model.hpp"

namespace eomgen::test {

/// A particle of mass m on a rod of length L about the origin, in spherical coordinates.
inline Definition pendulum() {
  Definition d("Spherical pendulum");
  d.parameter("m", "1 kg").parameter("L", "2 m").parameter("g", "9.81 m/s^2");
  d.add(
      "particle",
      {{"name", "P"}, {"mass", "m"}, {"position", Value::table({{"spherical", Value::list({"r", "phi", "theta"})}})}});
  d.add("force", {{"gravity", "-g*E3"}});
  d.add("constraint", {{"name", "rod"}, {"holonomic", "r - L"}});
  d.set("scene.default", "t", Value::list({0, 2}));
  d.set("scene.default", "initial", Value::table({{"phi", 1}, {"theta", 0}, {"phi_dot", 0}, {"theta_dot", 2}}));
  d.set("scene.default", "outputs", Value::list({"energy"}));
  return d;
}

/// A planar chain of n pendulums in relative angles, whose derivation takes long.
inline Definition chain(int n) {
  Definition d("Chain");
  std::string x = "0", z = "0", angle = "0";
  for (int i = 1; i <= n; ++i) {
    const std::string k = std::to_string(i);
    d.set("coordinates", "q" + k, Value::table({}));
    angle += " + q" + k;
    x += " + sin(" + angle + ")";
    z += " - cos(" + angle + ")";
    d.add("particle", {{"name", "P" + k}, {"mass", "1"}, {"position", Value::list({x, "0", z})}});
  }
  d.add("force", {{"gravity", "-9.81*E3"}});
  d.set("scene.default", "t", Value::list({0, 1}));
  return d;
}

}  // namespace eomgen::test
