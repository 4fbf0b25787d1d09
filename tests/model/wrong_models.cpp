// SPDX-License-Identifier: GPL-3.0-or-later
#include "wrong_models.hpp"

#include <doctest/doctest.h>

#include "support/particles.hpp"

namespace eomgen::model {

std::string pendulum(const std::vector<std::pair<std::string, std::string>>& edits, const std::string& more) {
  std::string text = R"(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "1 m"
)" + test::particle_in_space;
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  }
  return text + more;
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string result;
  for (std::size_t k = 0; k < times; ++k) result += text;
  return result;
}

std::string definitions_in_a_row(int count) {
  std::string result = "[definitions]\n";
  for (int k = 0; k < count; ++k) result += "d" + std::to_string(k) + " = \"d" + std::to_string(k + 1) + " + 1\"\n";
  return result + "d" + std::to_string(count) + " = \"R\"\n";
}

std::string numbered_parameters(int count) {
  std::string result;
  for (int k = 0; k < count; ++k) result += "n" + std::to_string(k) + " = 1\n";
  return result;
}

}  // namespace eomgen::model
