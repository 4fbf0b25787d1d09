// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that are narrow in the state: steps that cannot have missed one need no sample of their dense output. One
// coordinate x with its rate, and 1/(1 + (x/w)^2) or 1/(1 + (x_dot/w)^2).
#include "eom/hybrid/narrow_forces.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

namespace {

using eom::expressions::Op;
using eom::expressions::Table;
using eom::hybrid::NarrowForces;

constexpr int coordinate = 1, rate = 2;  // variables

eom::hybrid::Problem problem_with(const eom::hybrid::Code& code, int variable, double width) {
  eom::hybrid::Problem problem;
  problem.code = &code;
  problem.parameters = {width};
  problem.bounded.narrow = {Table{{{Op::number, {0}},
                                   {Op::variable, {variable}},
                                   {Op::parameter, {0}},
                                   {Op::div, {1, 2}},
                                   {Op::power, {3, 2}},
                                   {Op::add, {0, 4}},
                                   {Op::div, {0, 5}}},
                                  {1},
                                  {6}}};
  return problem;
}

/// Steps of size h of the free motion x = x0 + v t + a t^2/2, whose dense output counts its calls.
struct FreeMotion {
  double x0, v, a = 0;
  mutable int samples = 0;

  std::array<double, 2> at(double t) const { return {x0 + v * t + a * t * t / 2, v + a * t}; }

  /// Makes the check of n steps. Returns the shortest length that it allows.
  double check(const NarrowForces& narrow, double h, int n, bool has_derivatives = true) const {
    const eom::hybrid::Sampling sampling{{},
                                         [this](double t, const double* x, double* dx) {
                                           (void)t;
                                           dx[0] = x[1];
                                           dx[1] = a + 1e6 / (1 + 1e8 * x[0] * x[0]);
                                           return 0;
                                         },
                                         1e-9,
                                         1e-9};
    double shortest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < n; ++k) {
      const std::array<double, 2> from = at(k * h), to = at((k + 1) * h), f0{from[1], a}, f1{to[1], a};
      const eom::StepView step{k * h,
                               (k + 1) * h,
                               from,
                               to,
                               this,
                               [](const void* motion, double t, double* x) {
                                 const auto* self = static_cast<const FreeMotion*>(motion);
                                 ++self->samples;
                                 std::ranges::copy(self->at(t), x);
                               },
                               has_derivatives ? f0.data() : nullptr,
                               has_derivatives ? f1.data() : nullptr};
      shortest = std::min(shortest, narrow.longest(step, sampling).length);
    }
    return shortest;
  }
};

}  // namespace

TEST_CASE("narrow forces: steps that a wide function cannot hide from need no samples, a step over a bump does") {
  eom::hybrid::Code code;
  code.free = {0};
  const eom::hybrid::Problem wide = problem_with(code, coordinate, 1), bump = problem_with(code, coordinate, 1e-4);
  const FreeMotion through{-2, 1}, beside{-2, 0.1};
  CHECK(std::isinf(through.check(NarrowForces(wide), 0.1, 40)));
  CHECK(through.samples == 0);
  CHECK(std::isinf(beside.check(NarrowForces(bump), 0.1, 40)));  // it ends at x = -1.6
  CHECK(beside.samples == 0);
  CHECK(through.check(NarrowForces(bump), 0.3, 10) < 0.3);
  CHECK(through.samples > 0);
  through.samples = 0;
  CHECK(FreeMotion{-0.1, 1, -2.0 * 0.3}.check(NarrowForces(bump), 0.4, 1) < 0.4);  // it turns behind the bump
}

TEST_CASE("narrow forces: functions of rates take the derivatives of the step, samples if it has none") {
  eom::hybrid::Code code;
  code.free = {0};
  const eom::hybrid::Problem wide = problem_with(code, rate, 0.1);
  const FreeMotion motion{1, -2, 1};
  CHECK(std::isinf(motion.check(NarrowForces(wide), 0.1, 8)));  // to a rate of -1.2
  CHECK(motion.samples == 0);
  CHECK(std::isinf(motion.check(NarrowForces(wide), 0.1, 8, false)));
  CHECK(motion.samples > 0);
}

TEST_CASE("narrow forces: a box on which values show each other serves later steps, and another run") {
  eom::hybrid::Code code;
  code.free = {0};
  const eom::hybrid::Problem problem = problem_with(code, coordinate, 1);
  const NarrowForces narrow(problem);
  FreeMotion{3, 0.01}.check(narrow, 0.1, 20);
  const eom::hybrid::StepBoxes::State state = narrow.save();
  REQUIRE(state.functions.size() == 1);
  CHECK(state.functions[0].side == 1);
  CHECK_FALSE(state.is_extended);  // the last step needed no new box
  NarrowForces other(problem);
  other.restore(state);
  FreeMotion{3.015, 0.01}.check(other, 0.1, 1);
  CHECK_FALSE(other.save().is_extended);
}
