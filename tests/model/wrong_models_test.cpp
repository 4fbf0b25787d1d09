// SPDX-License-Identifier: GPL-3.0-or-later
#include "wrong_models.hpp"

#include <chrono>

#include "model_support.hpp"

namespace eomgen::model {

std::string pendulum(const std::vector<std::pair<std::string, std::string>>& edits, const std::string& more) {
  std::string text = R"(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "1 m"
[[particle]]
name = "P"
mass = "m"
position = { spherical = ["R", "phi", "theta"] }
[[force]]
gravity = "-g*E3"
)";
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

std::string numbered(int count) {
  std::string result;
  for (int k = 0; k < count; ++k) result += "n" + std::to_string(k) + " = 1\n";
  return result;
}

}  // namespace eomgen::model

using namespace eomgen::model;

namespace {

void refuse_all(const std::vector<WrongModel>& table) {
  for (const WrongModel& wrong : table) {
    CAPTURE(wrong.name);
    const auto start = std::chrono::steady_clock::now();
    try {
      read(wrong.text);
      FAIL_CHECK("accepted");
    } catch (const eomgen::Error& error) {
      const eomgen::Where& where = error.where();
      CHECK(error.stage() == "model");
      CHECK(error.exit_code() == 2);
      CHECK(where.file == "model.toml");
      CHECK((where.line == 0 ? "" : std::to_string(where.line) + ":" + std::to_string(where.column)) == wrong.place);
      CHECK(error.message() == wrong.message);
      CHECK(error.remedy() == wrong.remedy);
      const std::string place = wrong.place.empty() ? "" : wrong.place + ":";
      CHECK(std::string(error.what()).starts_with("model.toml:" + place + " error: " + wrong.message + "\n"));
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    CHECK(took.count() < 1.0);  // also without optimisation and under sanitizers
  }
}

}  // namespace

TEST_CASE("wrong names and keys are refused in exact words") { refuse_all(wrong_names()); }
TEST_CASE("wrong structure is refused in exact words") { refuse_all(wrong_structure()); }
TEST_CASE("wrong units and types are refused in exact words") { refuse_all(wrong_units()); }
TEST_CASE("wrong expressions are refused in exact words") { refuse_all(wrong_expressions()); }
TEST_CASE("wrong scenes are refused in exact words") { refuse_all(wrong_scenes()); }
TEST_CASE("hostile input is refused in exact words") { refuse_all(wrong_hostile()); }

TEST_CASE("the whole report of a refusal is what the user sees") {
  try {
    read(pendulum({}, "[[constraint]]\nname = \"rod\"\nholonomic = \"R - LL\"\n"));
    FAIL("accepted");
  } catch (const eomgen::Error& error) {
    CHECK(std::string(error.what()) ==
          "model.toml:14:18: error: the name 'LL' is not declared\n"
          "  14 | holonomic = \"R - LL\"\n"
          "     |                  ^~\n"
          "  remedy: did you mean 'L'?\n");
  }
}

TEST_CASE("there are more than forty wrong models") {
  CHECK(wrong_names().size() + wrong_structure().size() + wrong_units().size() + wrong_expressions().size() +
            wrong_scenes().size() + wrong_hostile().size() >
        100);
}
