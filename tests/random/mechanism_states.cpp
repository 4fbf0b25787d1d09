// SPDX-License-Identifier: GPL-3.0-or-later
// States of first order, discrete values, resets, samples and relays of a random mechanism.
#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {

/// A coordinate that neither a constraint nor the norm of Euler parameters determines; empty if there is none.
std::string MechanismBuilder::free_coordinate() {
  std::vector<std::string> fits;
  for (const std::string& q : coordinates_)
    if (!is_euler_parameter(q) && !follows_.contains(q)) fits.push_back(q);
  return fits.empty() ? "" : dice_.pick(fits);
}

void MechanismBuilder::add_states() {
  const std::string q = free_coordinate();
  if (q.empty()) return;
  std::vector<std::string> states;
  const std::size_t count = dice_.below(3);
  for (std::size_t k = 0; k < count; ++k) {
    feature("state");
    const std::string z = "z" + std::to_string(k + 1);
    const std::string driven =
        dice_.pick<std::string>({q + "_dot", "sin(" + q + ")", scalar_of_time(), "abs(" + q + ")"});
    const std::string coupled = states.empty() ? "" : " + " + value(10, 50) + "*" + dice_.pick(states) + "^2";
    place_lines_ += "[[state]]\nname = \"" + z + "\"\nrate = \"(" + driven + " - " + z + ")/" + value(20, 200) +
                    coupled + "\"\n" + (dice_.chance(30) ? "energy = \"" + z + "^2/2\"\n" : "") +
                    "initial = " + dice_.decimal(-100, 100) + "\n";
    states.push_back(z);
    force("generalized = { " + q + " = \"-" + value(20, 200) + "*" + z + "\" }");
  }
  if (dice_.chance(40)) {
    feature("relay");
    force("generalized = { " + q + " = \"-" + value(20, 300) + "*sign(" + q + "_dot" +
          (dice_.chance(50) ? " + " + value(20, 100) + "*" + q : "") + ")\" }");
  }
  if (dice_.chance(60)) add_resets(q, states);
}

void MechanismBuilder::add_resets(const std::string& q, const std::vector<std::string>& states) {
  feature("discrete value");
  discrete_lines_ += "d1 = { initial = " + dice_.decimal(0, 200) + " }\n";
  force("generalized = { " + q + " = \"" + value(20, 200) + "*d1 - " + value(10, 50) + "*" + q + "_dot\" }");
  if (dice_.chance(70)) {
    feature("reset");
    std::string set = "d1 = \"d1/2 + " + q + "\"";
    if (!states.empty() && dice_.chance(50)) set += ", " + dice_.pick(states) + " = \"d1 - " + q + "_dot\"";
    // Constraints act on new velocities. Those that eliminate coordinates leave nothing to set.
    if (dice_.chance(50) && constraints_ == 0 && !result_.constrained)
      set += ", " + q + "_dot = \"-" + dice_.decimal(20, 80) + "*" + q + "_dot\"";
    event_lines_ += "[[event]]\nname = \"hit\"\nwhen = \"" +
                    dice_.pick<std::string>({q + " - " + dice_.decimal(20, 120), q + "_dot", "t - 0.11"}) + "\"\n" +
                    (dice_.chance(30) ? "if = \"" + q + "_dot + d1 > 0\"\n" : "") + "set = { " + set + " }\n";
  }
  if (dice_.chance(70)) {
    feature("sample");
    event_lines_ += "[[sample]]\nevery = \"0.0" + std::to_string(3 + dice_.below(6)) + "\"\nset = { d1 = \"" +
                    dice_.pick<std::string>({q, "sin(" + q + "_dot)", "d1 + 1/10"}) + "\" }\n";
  }
}

}  // namespace eomgen::random_models
