// SPDX-License-Identifier: GPL-3.0-or-later
#include "wrong_models.hpp"

#include <doctest/doctest.h>

#include <chrono>

#include "model_support.hpp"

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
      const eomgen::SourceLocation& where = error.where();
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

TEST_CASE("wrong names and keys are rejected with the exact message") { refuse_all(wrong_names()); }
TEST_CASE("wrong structure is rejected with the exact message") { refuse_all(wrong_structure()); }
TEST_CASE("wrong units and types are rejected with the exact message") { refuse_all(wrong_units()); }
TEST_CASE("wrong expressions are rejected with the exact message") { refuse_all(wrong_expressions()); }
TEST_CASE("wrong scenes are rejected with the exact message") { refuse_all(wrong_scenes()); }
TEST_CASE("wrong bodies and rotations are rejected with the exact message") { refuse_all(wrong_bodies()); }
TEST_CASE("wrong forces are rejected with the exact message") { refuse_all(wrong_forces()); }
TEST_CASE("wrong resets are rejected with the exact message") { refuse_all(wrong_resets()); }
TEST_CASE("wrong states are rejected with the exact message") { refuse_all(wrong_states()); }
TEST_CASE("hostile input is rejected with the exact message") { refuse_all(wrong_hostile()); }

TEST_CASE("the complete error report is as the user sees it") {
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
