// SPDX-License-Identifier: GPL-3.0-or-later
#include "random/between_bodies.hpp"

#include <algorithm>

namespace eomgen::random_models {
namespace {

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

/// One value, or three.
std::string triple(RandomSource& dice, int low, int high) {
  if (dice.chance(40)) return quoted(dice.decimal(low, high));
  std::string list;
  for (int k = 0; k < 3; ++k) list += (k == 0 ? "" : ", ") + quoted(dice.decimal(low, high));
  return "[" + list + "]";
}

std::string on_body(RandomSource& dice, const std::string& body) {
  if (body == "ground") return "E1 - " + dice.decimal(20, 80) + "*E2";
  return dice.chance(30) ? body : body + " + " + dice.decimal(20, 80) + "*" + body + ".e1";
}

std::string bushing(RandomSource& dice, const std::string& a, const std::string& b) {
  std::string line = "bushing = { bodies = [" + quoted(a) + ", " + quoted(b) + "], at = [" + quoted(on_body(dice, a)) +
                     ", " + quoted(on_body(dice, b)) + "], stiffness = " + triple(dice, 100, 900);
  if (dice.chance(70)) line += ", coefficient = " + triple(dice, 10, 90);
  if (dice.chance(70)) line += ", rotational_stiffness = " + triple(dice, 50, 400);
  if (dice.chance(70)) line += ", rotational_coefficient = " + triple(dice, 5, 50);
  return line + " }";
}

}  // namespace

std::string forces_between(RandomSource& dice, const std::vector<std::string>& bodies, bool planar,
                           std::set<std::string>& features) {
  std::string tables;
  const std::size_t count = bodies.empty() ? 0 : 1 + dice.below(2);
  for (std::size_t k = 0; k < count; ++k) {
    const std::string b = dice.pick(bodies);
    std::string a = dice.chance(40) ? "ground" : dice.pick(bodies);
    if (a == b) a = "ground";
    const std::string far = quoted(dice.decimal(250, 400) + "*E1"), end = quoted(on_body(dice, b));
    std::string line;
    switch (dice.below(4)) {
      case 0:
        features.insert("bushing");
        line = bushing(dice, a, b);
        break;
      case 1:
        features.insert("spring_damper");
        line = "spring_damper = { between = [" + end + ", " + far + "], stiffness = " + quoted(dice.decimal(100, 900)) +
               (dice.chance(60) ? ", length = " + quoted(dice.decimal(20, 120)) : "") +
               ", coefficient = " + quoted(dice.decimal(10, 90)) + " }";
        break;
      case 2:
        features.insert("linear_actuator");
        line = "linear_actuator = { between = [" + far + ", " + end + "], force = " +
               quoted(dice.decimal(50, 300) + "*cos(2*t) - " + dice.decimal(5, 40) + "*dot(velocity(" + b + "), E1)") +
               " }";
        break;
      default:
        features.insert("rotary_actuator");
        line = "rotary_actuator = { bodies = [" + quoted(a) + ", " + quoted(b) +
               "], axis = " + quoted(planar ? "E3" : "E1 + 0.7*" + b + ".e2 - 0.4*E3") +
               ", moment = " + quoted(dice.decimal(50, 300) + "*sin(3*t)") + " }";
    }
    tables += "[[force]]\n" + line + "\n";
  }
  return tables;
}

}  // namespace eomgen::random_models
