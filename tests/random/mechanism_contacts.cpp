// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts and dry friction of a random mechanism.
#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {

std::string MechanismBuilder::coulomb() {
  if (dice_.chance(15)) {
    feature("smooth friction");
    return "friction = { dynamic = \"" + value(10, 60) + "\", law = \"smooth\", width = \"0.01\" }\n";
  }
  feature("dry friction");
  const std::string dynamic = dice_.decimal(10, 60);
  return "friction = { static = \"" + (dice_.chance(50) ? dynamic : dice_.decimal(61, 90)) + "\", dynamic = \"" +
         dynamic + "\" }\n";
}

std::string MechanismBuilder::one_sided() {
  feature("unilateral");
  return std::string("holds = \"unilateral\"\n") + (dice_.chance(60) ? "restitution = \"" + value(0, 90) + "\"\n" : "");
}

void MechanismBuilder::contact(const std::string& kind, const std::string& lines) {
  feature(kind);
  constraint_lines_ += "[[constraint]]\nname = \"c" + std::to_string(++constraints_) + "\"\n" + lines;
}

// Adds at most three contacts, the limit of the program: a floor below the start of a place, a rough floor through it,
// guides with dry friction, a ball on rough ground.
void MechanismBuilder::add_contacts() {
  const std::string up = planar_ ? "E2" : "E3";
  const std::size_t count = 1 + dice_.below(3);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t kind = dice_.below(4);
    const Place& a = one_of([&](const Place& p) {
      return p.free_position && (kind != 1 || !p.body) && (kind != 3 || (p.body && p.spatial_rotation));
    });
    const std::string height = a.free_position ? a.own.back() : "";
    switch (kind) {
      case 0:  // a floor below the start, for places whose start is known only by coordinates
        if (height.empty())
          contact("floor",
                  "holonomic = \"dot(" + point_of(a) + ", " + up + ") + " + value(200, 400) + "\"\n" + one_sided());
        if (height.empty() || follows_.contains(height) || result_.constrained) break;
        contact("floor",
                "holonomic = \"" + height + " - initial(" + height + ") + " + value(1, 30) + "\"\n" + one_sided());
        break;
      case 1:  // a rough floor through the start, horizontal or inclined
        if (height.empty() || follows_.contains(height) || a.body || result_.constrained) break;
        contact("rough surface", "holonomic = \"" + height +
                                     (dice_.chance(50) ? " - " + value(10, 40) + "*" + a.own[0] : std::string()) +
                                     " - " + value(10, 90) + "\"\n" + coulomb() +
                                     (dice_.chance(30) ? one_sided() : std::string()));
        follows_.insert(height);
        break;
      case 2: {
        const std::string q = dice_.pick(coordinates_);
        if (is_euler_parameter(q) || !dry_.insert(q).second) break;
        feature("dry force");
        const std::string dynamic = dice_.decimal(10, 60);
        force("dry = { coordinate = \"" + q + "\", normal = \"" + value(50, 300) + "\", static = \"" +
              (dice_.chance(50) ? dynamic : dice_.decimal(61, 90)) + "\", dynamic = \"" + dynamic + "\" }");
        break;
      }
      default: {
        if (planar_ || !a.body || !a.free_position || !a.spatial_rotation || rolling_ || result_.constrained) break;
        rolling_ = true;
        const bool is_open = dice_.chance(40);
        const std::string radius = is_open ? dice_.decimal(1, 9) : value(20, 60);
        contact("rough ball", std::string(dice_.chance(70) ? "rolling" : "sliding") + " = { body = \"" + a.name +
                                  "\", shape = { sphere = \"" + radius +
                                  "\" }, on = \"ground\" }\nfriction = { static = \"0.5\", dynamic = \"" +
                                  dice_.decimal(10, 50) + "\" }\n" + (is_open ? one_sided() : std::string()));
        if (!is_open) follows_.insert(height);
      }
    }
  }
}

}  // namespace eomgen::random_models
