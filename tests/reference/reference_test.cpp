// SPDX-License-Identifier: GPL-3.0-or-later
// Reference runs against closed forms, and against themselves run backwards.
#include "reference/reference.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "error.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/elliptic.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

constexpr double rounded =
    1e-15;  // results are rounded once to binary64; closed forms in binary64 are off by some units in the last place
constexpr double closed_form = 2e-14;

reference::Problem problem(const program::Program& program, std::vector<double> x, std::vector<double> p, double t0,
                           double t1) {
  return {program.functions.front(), std::move(x), std::move(p), t0, {{t1, {0, 0}}}, {t0 + (t1 - t0) / 3, t1}, nullptr};
}

}  // namespace

TEST_CASE("reference: a pendulum agrees with its closed form at each requested time, and claims 30 digits") {
  const auto built = build(pendulum());
  const auto solution = reference::solve(problem(built, {1.5, 0}, {1, 1, 9}, 0, 6));  // frequency 3 for small swings
  CHECK(solution.digits >= 30);
  CHECK(solution.digits_at_end >= solution.digits);
  REQUIRE(solution.x.size() == 2);
  for (std::size_t j = 0; j < 2; ++j) {
    const auto exact = test::pendulum_from_rest(1.5, 3, j == 0 ? 2 : 6);
    CHECK(std::abs(solution.x[j][0] - exact.angle) < closed_form);
    CHECK(std::abs(solution.x[j][1] - exact.rate) < 3 * closed_form);
  }
}

TEST_CASE("reference: stiff or chaotic motions lose digits, and only the remaining ones are claimed") {
  const auto built = build(double_pendulum());
  const std::vector<double> p{1, 1, 1, 1, 9.81}, start{2.5, -2, 0, 0};  // errors grow by some e^(4 t)
  const auto near = reference::solve(problem(built, start, p, 0, 1)),
             far = reference::solve(problem(built, start, p, 0, 6));
  CHECK(near.digits_at_end >= 30);
  CHECK(far.digits_at_end < near.digits_at_end);
  CHECK(far.digits_at_end >= 20);
  const auto rough = reference::solve(problem(built, start, p, 0, 6), {22, 24}, {30, 32});
  const double difference = std::abs(rough.x[1][0] - far.x[1][0]);
  CHECK(difference <= rounded + 10 * std::pow(10.0, -rough.digits_at_end));
}

TEST_CASE("reference: a run forward and back returns to its start") {
  const auto built = build(double_pendulum());
  const std::vector<double> p{1, 2, 1, 0.5, 9.81}, start{0.5, -0.3, 0.25, 0};
  const auto there = reference::solve(problem(built, start, p, 0, 3));
  const auto back = reference::solve(problem(built, there.x[1], p, 3, 0));
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(std::abs(back.x[1][i] - start[i]) < 1e-12);  // the intermediate state was rounded to binary64
}

TEST_CASE("reference: inputs are constant on each segment") {
  const auto built = build(cart_pendulum());
  reference::Problem whole = problem(built, {0, 0.25, 0, 0}, {2, 1, 1, 9.81, 0.5}, 0, 2);
  whole.segments = {{1, {3}}, {2, {-3}}};
  whole.times = {1, 2};
  const auto both = reference::solve(whole);
  reference::Problem second = whole;
  second.t0 = 1;
  second.x = both.x[0];
  second.segments = {{2, {-3}}};
  second.times = {2};
  const auto alone = reference::solve(second);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(alone.x[0][i] - both.x[1][i]) < 1e-14);
}

TEST_CASE("reference: a run that cannot continue reports the time and the reason") {
  const SystemBuilder
      k;  // qddot = -sqrt(q) from rest at 1 meets 0, where the root is singular, at B(2/3, 1/2)/sqrt(3) = 1.49371
  system::EquationSystem system;
  system.dag = k.dag;
  system.formulation = "lagrange";
  system.free = {0};
  system.M = {k.dag->one()};
  system.f = {k.dag->neg(k.dag->call(Op::sqrt, k.q(0).ref))};
  const auto built = build(system);
  CHECK_THROWS_WITH_AS(reference::solve(problem(built, {1, 0}, {0}, 0, 100)),
                       doctest::Contains("the reference ends at t = 1.493"), Error);
}
