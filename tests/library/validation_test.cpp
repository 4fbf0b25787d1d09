// SPDX-License-Identifier: GPL-3.0-or-later
// The library refuses the numbers that the command line refuses, before it computes anything.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "library/example_definitions.hpp"

using namespace eomgen;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), largest = std::numeric_limits<double>::max();

/// The message of the Error that `call` throws; "" if it throws none.
template <class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

}  // namespace

TEST_CASE("library: a run refuses numbers that the command line refuses, and names the option") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const auto message = [&](const RunOptions& options) { return message_of([&] { (void)model.run(options); }); };
  for (const double bad : {double{NAN}, infinity, -infinity}) {
    CHECK(message({.t_end = bad}).find("the option t_end") == 0);
    CHECK(message({.rtol = bad}).find("the option rtol") == 0);
    CHECK(message({.atol = bad}).find("the option atol") == 0);
  }
  CHECK(message({.rtol = -1e-9}).find("the option rtol") == 0);
  for (const double bad : {double{NAN}, infinity, -0.1, 0.0}) {
    CHECK(message({.step = bad}).find("the option step") == 0);
    CHECK(message({.max_step = bad}).find("the option max_step") == 0);
    CHECK(message({.every = bad}).find("the option every") == 0);
  }
  CHECK(message({.max_steps = SIZE_MAX}).find("the option max_steps") == 0);
}

TEST_CASE("library: rows that are not distinct, or that fill the memory, are refused") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const auto message = [&](const RunOptions& options) { return message_of([&] { (void)model.run(options); }); };
  CHECK(message({.every = 1e-300}).find("lost in the rounding of t = 2") != std::string::npos);
  CHECK(message({.every = 1e-9}).find("2e+09 rows") != std::string::npos);
  // Rows that are passed on take no memory.
  std::size_t rows = 0;
  const Motion motion =
      model.run({.t_end = 1e-5, .every = 1e-10, .row = [&](double, std::span<const double>) { ++rows; }});
  CHECK(motion.is_complete());
  CHECK(rows == 100001);
}

TEST_CASE(
    "library: a time, a step, a longest step or an interval near the largest number ends in an Error or an outcome") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  for (const double large : {1e300, largest}) {
    for (const RunOptions& options : {RunOptions{.t_end = large, .max_steps = 100}, RunOptions{.step = large},
                                      RunOptions{.max_step = large}, RunOptions{.every = large}}) {
      (void)message_of([&] { CHECK(!model.run(options).outcome.empty()); });
    }
  }
}

TEST_CASE("library: simulations and analyses refuse numbers that the command line refuses") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const CompiledModel compiled = model.compile();
  for (const double bad : {double{NAN}, infinity, -1.0}) {
    const auto message = [&](const SimulationOptions& o) { return message_of([&] { Simulation s(compiled, o); }); };
    CHECK(message({.rtol = bad}).find("the option rtol") == 0);
    CHECK(message({.step = bad}).find("the option step") == 0);
    CHECK(message({.max_step = bad}).find("the option max_step") == 0);
    CHECK(message({.every = bad}).find("the option every") == 0);
    CHECK(message_of([&] { (void)model.inverse_dynamics({.every = bad}); }).find("the option every") == 0);
    CHECK(message_of([&] { (void)model.benchmark({.max_seconds = bad}); }).find("the option max_s") == 0);
    CHECK(message_of([&] { (void)model.stress_test({.max_seconds = bad}); }).find("the option max_s") == 0);
  }
  CHECK(message_of([&] { (void)model.linearise({.time = NAN}); }).find("the option time") == 0);
  CHECK(message_of([&] { (void)model.steady_motions({.starts = 0}); }).find("the option starts") == 0);
  CHECK(message_of([&] { (void)model.stress_test({.max_steps = 0}); }).find("the option max_steps") == 0);
  CHECK(message_of([&] { (void)model.verify({.points = SIZE_MAX}); }).find("the option points") == 0);
  CHECK(message_of([&] { (void)model.verify({.digits = -1}); }).find("the option digits") == 0);
  Simulation often(compiled, {.every = 1e-300});
  CHECK(message_of([&] { (void)often.advance(1); }).find("lost in the rounding") != std::string::npos);
}
