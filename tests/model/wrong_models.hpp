// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid models with the exact error messages. A changed message must be changed here too.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace eomgen::model {

struct WrongModel {
  std::string name;
  std::string text;
  std::string place;  // "line:column"
  std::string message;
  std::string remedy;
};

/// A pendulum without its rod; each edit replaces the first occurrence of a text, `more` is appended.
std::string pendulum(const std::vector<std::pair<std::string, std::string>>& edits, const std::string& more = "");
std::string repeated(const std::string& text, std::size_t times);
/// d0 = "d1 + 1", d1 = "d2 + 1", ... under [definitions]
std::string definitions_in_a_row(int count);
/// n0 = 1, n1 = 1, ...
std::string numbered_parameters(int count);

std::vector<WrongModel> wrong_names();
std::vector<WrongModel> wrong_structure();
std::vector<WrongModel> wrong_units();
std::vector<WrongModel> wrong_expressions();
std::vector<WrongModel> wrong_scenes();
std::vector<WrongModel> wrong_hostile();
std::vector<WrongModel> wrong_bodies();
std::vector<WrongModel> wrong_forces();
std::vector<WrongModel> wrong_resets();
std::vector<WrongModel> wrong_states();

}  // namespace eomgen::model
