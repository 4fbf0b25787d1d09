// SPDX-License-Identifier: MIT
// Event functions that keep their signs in a step, by bounds on boxes around it: one coordinate x with the gap x - p.
#include "eom/hybrid/clearance.hpp"

#include <doctest/doctest.h>

#include <array>
#include <vector>

namespace {

using eom::expressions::Op;
using eom::expressions::Table;
using eom::hybrid::Clearance;
using eom::hybrid::EventRanges;
using eom::hybrid::StepVariables;

/// x - p, and a function of the rate.
std::vector<Table> functions() {
  return {{{{Op::variable, {1}}, {Op::parameter, {0}}, {Op::sub, {0, 1}}}, {}, {2}}, {{{Op::variable, {2}}}, {}, {0}}};
}

/// A step of 1 s between two states (x, x_dot).
struct Step {
  std::array<double, 2> from, to;
  eom::StepView view() const { return {0, 1, from, to}; }
};

}  // namespace

TEST_CASE("clearance: a gap is clear far from zero, on its side only, and where the path cannot reach it") {
  const EventRanges ranges(functions(), StepVariables(2, 0), std::vector<double>{1});
  const auto is_clear = [&](const Step& step, int side) {
    Clearance clearance(ranges, 2, 1);
    clearance.begin_step(step.view());
    return clearance.is_clear(0, side);
  };
  CHECK(is_clear({{3, -0.1}, {2.9, -0.1}}, 1));
  CHECK_FALSE(is_clear({{3, -0.1}, {2.9, -0.1}}, -1));
  CHECK(is_clear({{-3, -0.1}, {-3.1, -0.1}}, -1));
  CHECK_FALSE(is_clear({{1.5, -1}, {0.5, -1}}, 1));  // it crosses
  CHECK_FALSE(is_clear({{1.1, -2}, {1.1, 2}}, 1));   // both ends are on the side: it dips to 0.6
  CHECK_FALSE(is_clear({{1, 1}, {2, 1}}, 1));        // it begins at zero
}

TEST_CASE("clearance: functions of rates are never clear") {
  const EventRanges ranges(functions(), StepVariables(2, 0), std::vector<double>{1});
  Clearance clearance(ranges, 2, 1);
  clearance.begin_step(Step{{3, 5}, {8, 5}}.view());
  CHECK_FALSE(clearance.is_clear(1, 1));
}

TEST_CASE("clearance: later steps within the box need no new one, and another run takes it with equal parameters") {
  const EventRanges ranges(functions(), StepVariables(2, 0), std::vector<double>{1});
  Clearance clearance(ranges, 2, 1);
  int boxes = 0;
  double x = 10;
  for (int k = 0; k < 60; ++k, x -= 0.1) {
    clearance.begin_step(Step{{x, -0.1}, {x - 0.1, -0.1}}.view());
    REQUIRE(clearance.is_clear(0, 1));
    boxes += clearance.is_extended() ? 1 : 0;
  }
  CHECK(boxes < 20);
  const Clearance::State state = clearance.save({1});
  const Step last{{x, -0.1}, {x - 0.1, -0.1}};
  clearance.begin_step(last.view());
  REQUIRE(clearance.is_clear(0, 1));
  for (const double p : {1.0, 2.0}) {
    CAPTURE(p);
    Clearance other(ranges, 2, 1);
    other.restore(state, {p});
    other.begin_step(last.view());
    CHECK(other.is_clear(0, 1));
    CHECK(other.is_extended() == (p == 1 ? clearance.is_extended() : true));
  }
}
