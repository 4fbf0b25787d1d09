// SPDX-License-Identifier: GPL-3.0-or-later
// A restricted function computes its results and nothing else.
#include "program/restrict.hpp"

#include <doctest/doctest.h>

#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

TEST_CASE("restriction: entries in any order keep their values with fewer instructions; no entries need no code") {
  for (const auto& system : {double_pendulum(), cart_pendulum(), chain(4)}) {
    const program::Function whole = build(system).functions[0];
    const std::size_t n = whole.results[0].entries.size();
    const std::vector<std::size_t> places{n - 1, 0, n - 1};
    const program::Function part = program::restrict_results(whole, places);
    CHECK(part.code.size() <= whole.code.size());
    const auto arguments = arguments_at<cln::cl_R>(system, 1);
    const auto all = program::interpret(whole, arguments, 60).results[0],
               some = program::interpret(part, arguments, 60).results[0];
    REQUIRE(some.size() == places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      CHECK(difference({all[places[i]]}, {some[i]}) < tolerances::same_value);
    CHECK(program::restrict_results(whole, {0}).code.empty());  // a rate is an entry of the state
  }
}
