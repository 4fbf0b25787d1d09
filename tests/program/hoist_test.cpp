// SPDX-License-Identifier: GPL-3.0-or-later
// Computations of parameters only are hoisted, and no others.
#include <doctest/doctest.h>

#include <algorithm>

#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

const program::Function* function_of(const program::Program& program, const std::string& name) {
  const auto found = std::find_if(program.functions.begin(), program.functions.end(),
                                  [&](const program::Function& function) { return function.name == name; });
  return found == program.functions.end() ? nullptr : &*found;
}

bool reads(const program::Function& function, program::Slot slot) {
  for (const auto& instruction : function.code) {
    for (const auto& operand : instruction.operands) {
      if (operand.slot == slot) return true;
    }
  }
  return false;
}

}  // namespace

TEST_CASE("hoisting: prepare and rhs_prepared agree with rhs to 45 digits, and cost less") {
  std::size_t split = 0;
  for (const auto& system : {pendulum(), double_pendulum(), cart_pendulum(), spherical_pendulum(),
                             massless_coordinate(), chain(3), chain(6)}) {
    CAPTURE(system.free.size());
    const auto built = build(system);
    const auto* prepare = function_of(built, "prepare");
    const auto* rest = function_of(built, "rhs_prepared");
    CHECK((prepare == nullptr) == (rest == nullptr));
    CHECK(built.prepared_count() == (prepare == nullptr ? 0 : prepare->results[0].entries.size()));
    if (rest == nullptr) continue;
    ++split;
    CHECK(rest->operations.cost() + 2 <= built.functions[0].operations.cost());
    for (std::uint64_t point = 0; point < 3; ++point) {
      auto arguments = arguments_at<cln::cl_R>(system, point);
      const auto expected = program::interpret(built.functions[0], arguments, 60).results[0];
      arguments.w = program::interpret(*prepare, arguments, 60).results[0];
      CHECK(difference(expected, program::interpret(*rest, arguments, 60).results[0]) < tolerances::same_value);
    }
  }
  CHECK(split >= 4);
}

TEST_CASE("hoisting: prepare reads parameters only, and no operation on parameters remains in the rest") {
  for (const auto& system : {double_pendulum(), cart_pendulum(), spherical_pendulum(), chain(3)}) {
    const auto built = build(system);
    const auto* prepare = function_of(built, "prepare");
    const auto* rest = function_of(built, "rhs_prepared");
    REQUIRE((rest != nullptr));
    for (const auto slot : {program::Slot::time, program::Slot::state, program::Slot::input, program::Slot::prepared}) {
      CHECK_FALSE(reads(*prepare, slot));
    }
    std::vector<bool> constant;
    for (const auto& instruction : rest->code) {
      const auto fixed = [&](const program::Operand& operand) {
        if (operand.slot == program::Slot::value) return static_cast<bool>(constant[operand.index]);
        return operand.slot == program::Slot::parameter || operand.slot == program::Slot::constant;
      };
      constant.push_back(std::all_of(instruction.operands.begin(), instruction.operands.end(), fixed));
      CHECK_FALSE(constant.back());
    }
  }
}

TEST_CASE("hoisting: prepare reports parameters that make the mass matrix singular") {
  const auto built = build(double_pendulum());
  const auto* prepare = function_of(built, "prepare");
  REQUIRE((prepare != nullptr));
  CHECK_FALSE(prepare->pivots.empty());
}

TEST_CASE("hoisting: with fixed parameters nothing is prepared") {
  std::vector<system::EquationSystem> candidates{pendulum()};
  program::Request request;
  for (std::uint32_t i = 0; i < 3; ++i) request.fix[i] = 2;
  CHECK(program::build_program(candidates, request).prepared_count() == 0);
}
