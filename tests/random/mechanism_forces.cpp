// SPDX-License-Identifier: GPL-3.0-or-later
// Forces and given energies of a random mechanism.
#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {

void MechanismBuilder::add_forces() {
  if (dice_.chance(75)) force("gravity = \"-9.81*" + std::string(planar_ ? "E2" : "E3") + "\"");
  const std::size_t count = dice_.below(4);
  for (std::size_t k = 0; k < count; ++k) {
    const Place& a = places_[dice_.below(places_.size())];
    switch (dice_.below(9)) {
      case 0:
      case 1: {
        const std::string other = "\"" + value(150, 300) + "*E1\"";
        feature("spring");
        force("spring = { between = [\"" + point_of(a) + "\", " + other + "], stiffness = \"" + value(100, 900) +
              "\", length = \"" + value(20, 120) + "\" }");
        break;
      }
      case 2:
        feature("damper");
        force("damper = { between = [\"" + point_of(a) + "\", \"" + value(150, 300) + "*E2\"], coefficient = \"" +
              value(10, 90) + "\" }");
        break;
      case 3:
        if (a.angles.empty() || a.euler_parameters) break;
        feature("torsion");
        force("torsion = { angle = \"" + dice_.pick(a.angles) + "\", stiffness = \"" + value(50, 400) +
              "\", coefficient = \"" + value(5, 50) + "\" }");
        break;
      case 4:
        if (!a.body) break;
        feature("follower force");
        force("on = \"" + point_of(a) + "\"\nforce = \"" + scalar_of_time() + "*" + body_axis(a) + "\"");
        break;
      case 5:
        if (!a.body) break;
        feature("moment");
        force("on = \"" + a.name + "\"\nmoment = \"" + scalar_of_time() + "*" + (planar_ ? "E3" : body_axis(a)) + "\"");
        break;
      case 6:
        feature("force");
        force("on = \"" + point_of(a) + "\"\nforce = \"" + scalar_of_time() + "*" + direction() + " - " + value(5, 40) +
              "*velocity(" + a.name + ")\"");
        break;
      case 7:
        feature("drag");
        force("drag = { on = \"" + a.name + "\", density = \"1.2\", area = \"" + value(10, 50) +
              "\", coefficient = \"0.47\" }");
        break;
      default: {
        feature("generalized force");
        const std::string q = dice_.pick(coordinates_);
        force("generalized = { " + q + " = \"" + scalar_of_time() + " - " + value(5, 40) + "*" + q + "_dot\" }");
      }
    }
  }
}

void MechanismBuilder::add_energies() {
  if (!dice_.chance(12)) return;
  feature("energy given");
  const std::string q = dice_.pick(coordinates_);
  energy_ = "kinetic = \"1/2*" + value(20, 90) + "*" + q + "_dot^2\"\npotential = \"1/2*" + value(50, 300) + "*" + q +
            "^2\"\n";
}

}  // namespace eomgen::random_models
