// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a random mechanism that depend on time: kinks, some of them at the start of the run, states with a rate of
// time alone, integrals, inputs of the scene, and start values that depend on earlier ones.
#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {

/// A prescribed motion with kinks, at the start of the run or in it.
std::string MechanismBuilder::kink_of_time() {
  feature("kink in time");
  const std::string a = dice_.decimal(10, 40), w = dice_.decimal(100, 900);
  return dice_.pick<std::string>({a + "*abs(sin(" + w + "*t))", "max(0, " + a + "*t)", a + "*abs(t)",
                                  a + "*abs(t - 0.13)", "if(t < 0, 0, " + a + "*t^2)", a + "*sin(" + w + "*t)"});
}

void MechanismBuilder::add_times() {
  const std::string q = free_coordinate();
  if (q.empty()) return;
  if (dice_.chance(50)) {
    feature("state of time");
    const std::string rate = dice_.pick<std::string>(
        {"cos(" + dice_.decimal(50, 300) + "*t)", "exp(-t^2)", "abs(t - 0.1)", "if(t < 0.2, 1, -1)"});
    place_lines_ += "[[state]]\nname = \"s1\"\nrate = \"" + rate + "\"\ninitial = " + dice_.decimal(-100, 100) + "\n";
    force("generalized = { " + q + " = \"-" + value(20, 200) + "*s1\" }");
  }
  if (dice_.chance(30)) {
    feature("integral");
    const std::string inner =
        dice_.pick<std::string>({"exp(-t^2)", "abs(sin(9*t))", "sin(" + q + ")", q + "_dot^2", "max(0, t - 0.1)"});
    force("generalized = { " + q + " = \"" + value(20, 200) + "*integral(" + inner + ")\" }");
  }
  if (dice_.chance(50)) {
    feature("input over time");
    const std::string u = "u" + std::to_string(++inputs_);
    input_lines_ += u + " = { default = 0 }\n";
    force("generalized = { " + q + " = \"" + value(20, 200) + "*" + u + "\" }");
  }
  if (dice_.chance(30)) {
    feature("initial");
    force("generalized = { " + q + " = \"-" + value(20, 200) + "*(" + q + " - initial(" + q + "))\" }");
  }
}

/// An input over time, in the scene.
std::string MechanismBuilder::signal() {
  const std::string a = dice_.decimal(50, 300), w = dice_.decimal(100, 900);
  return dice_.pick<std::string>({"\"" + a + "*sin(" + w + "*t)\"", "\"if(t < 0.12, " + a + ", -1)\"",
                                  "\"" + a + "*abs(t)\"", "{ t = [0, 0.1], value = [" + a + ", -1] }", a});
}

/// A start value: the number, or a formula of a coordinate before it.
std::string MechanismBuilder::start_value(std::size_t of, bool rate, const std::string& number) {
  if (!times_ || !dice_.chance(40)) return number;
  std::vector<std::string> before;
  for (std::size_t i = 0; i < of + (rate ? 1 : 0); ++i) {
    if (!starts_[i].first.empty() && !follows_.contains(coordinates_[i]) && !is_euler_parameter(coordinates_[i]))
      before.push_back(coordinates_[i]);
  }
  if (before.empty() || is_euler_parameter(coordinates_[of])) return number;
  feature("start of others");
  return "\"" + number + " + 0.1*sin(" + dice_.pick(before) + ")\"";
}

}  // namespace eomgen::random_models
