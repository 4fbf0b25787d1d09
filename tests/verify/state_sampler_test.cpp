// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/state_sampler.hpp"

#include <doctest/doctest.h>

#include "oracle/linear_solve.hpp"
#include "oracle/motion.hpp"
#include "verify/near.hpp"
#include "verify/sample_models.hpp"

using namespace eomgen;
using namespace eomgen::verify;
using namespace eomgen::verify::test;

namespace {

constexpr std::size_t many = 100;

}  // namespace

TEST_CASE("points: states satisfy the constraints and their rates to all digits") {
  for (const model::Model& m : {moving_sphere(), rod_pendulum()}) {
    const Oracle oracle(m, 60);
    StateSampler points(oracle, 7, many);
    for (int i = 0; i < 10; ++i) {
      const State s = points.next();
      const ConstraintValues c = oracle.constraint_values(s);
      CHECK(near(c.psi[0], 0, 57, 1));
      CHECK(near(c.psi_dot[0], 0, 57, 1));
    }
  }
}

TEST_CASE("points: the same seed gives the same states, another seed others") {
  const model::Model m = moving_sphere();
  const Oracle oracle(m, 60);
  StateSampler a(oracle, 3, many), b(oracle, 3, many), c(oracle, 4, many);
  for (int i = 0; i < 3; ++i) {
    const State x = a.next(), y = b.next(), z = c.next();
    CHECK(x.q == y.q);
    CHECK(x.qdot == y.qdot);
    CHECK(x.parameters == y.parameters);
    CHECK(x.q != z.q);
  }
}

TEST_CASE("points: coordinates stay inside their ranges, away from the ends, and parameters keep their signs") {
  const model::Model m = moving_sphere();
  const Oracle oracle(m, 60);
  StateSampler points(oracle, 11, many);
  for (int i = 0; i < 50; ++i) {
    const State s = points.next();
    CHECK(cln::double_approx(s.q[1]) > 0.07);
    CHECK(cln::double_approx(s.q[1]) < 3.07);
    for (const Real& value : s.parameters) CHECK(cln::plusp(value));
  }
}

TEST_CASE("points: undefined states are rejected and counted; too many rejections are an error with the reasons") {
  model::Model m = chain(1);
  const ModelFormula th = leaf(m, Op::coordinate, 0);
  generalized(m, 0, call(Fn::log, th));  // undefined for negative angles
  const Oracle oracle(m, 60);
  StateSampler points(oracle, 5, many);
  for (int i = 0; i < 20; ++i) CHECK(cln::plusp(points.next().q[0]));
  REQUIRE(points.rejected().size() == 1);
  CHECK(points.rejected().begin()->first == "log of a number that is not positive");
  CHECK(points.rejected().begin()->second > 3);

  model::Model never = chain(1);
  generalized(never, 0, call(Fn::log, number(never, -1)));
  const Oracle of_never(never, 60);
  StateSampler none(of_never, 5, many);
  try {
    none.next();
    FAIL("a state was found");
  } catch (const Error& error) {
    CHECK(error.fault() == ErrorKind::check);
    CHECK(error.message().find("log of a number that is not positive (101)") != std::string::npos);
  }
}

TEST_CASE("points: undefined numbers of a scene, an input or a parameter are reported with their position") {
  const auto refusal_of = [](const auto& spoil) {
    model::Model m = cart_pendulum();
    spoil(m, call(Fn::log, number(m, 0)).id);
    try {
      StateSampler(Oracle(m, 60), 5, many);
    } catch (const Error& error) {
      CHECK(error.fault() == ErrorKind::input);
      return error.message();
    }
    return std::string();
  };
  const std::string expected = "this has no value: log of a number that is not positive";
  CHECK(refusal_of([](model::Model& m, model::NodeId bad) { m.scenes.front().t0 = bad; }) == expected);
  CHECK(refusal_of([](model::Model& m, model::NodeId bad) {
          m.scenes.front().t0 = number(m, 0).id;
          m.scenes.front().t1 = bad;
        }) == expected);
  CHECK(refusal_of([](model::Model& m, model::NodeId bad) { m.scenes.front().parameters = {{0, bad}}; }) == expected);
  CHECK(refusal_of([](model::Model& m, model::NodeId bad) { m.inputs.front().default_value = bad; }) == expected);
  CHECK(refusal_of([](model::Model& m, model::NodeId bad) { m.parameters.front().value = bad; }) == expected);
  CHECK(refusal_of([](model::Model& m, model::NodeId bad) { m.coordinates.front().lower = bad; }) == expected);
}

TEST_CASE("points: states keep a distance from kinks, contradictory constraints have no states") {
  model::Model m = chain(1);
  const ModelFormula th = leaf(m, Op::coordinate, 0);
  generalized(m, 0, call(Fn::abs, th - th));  // always at the kink
  const Oracle oracle(m, 60);
  StateSampler points(oracle, 5, many);
  CHECK_THROWS_AS(points.next(), Error);
  CHECK(points.rejected().count("too near the kink") == 1);

  model::Model fixed = chain(1);  // a kink of numbers alone is no kink of the states
  generalized(fixed, 0, call(Fn::abs, number(fixed, 0)));
  const Oracle of_fixed(fixed, 60);
  StateSampler everywhere(of_fixed, 5, many);
  CHECK_NOTHROW(everywhere.next());
  CHECK(everywhere.rejected().empty());

  model::Model twice = rod_pendulum();
  const ModelFormula x = leaf(twice, Op::coordinate, 0), y = leaf(twice, Op::coordinate, 1);
  holonomic(twice, "again", {2 * ((x ^ 2) + (y ^ 2)) - 2 * (leaf(twice, Op::parameter, 2) ^ 2)});
  const Oracle of_twice(twice, 60);
  StateSampler none(of_twice, 5, many);
  CHECK_THROWS_AS(none.next(), Error);
  CHECK(none.rejected().count("the constraints lose rank") == 1);
}

TEST_CASE("oracle: the solved motion of P7 satisfies (2.109), and its reaction is (2.111)") {
  const model::Model m = moving_sphere();
  const Oracle oracle(m, 60);
  StateSampler points(oracle, 9, many);
  for (int i = 0; i < 5; ++i) {
    const Motion motion = solve_motion(oracle, points.next());
    const State& s = motion.state;
    const Real &mass = s.parameters[0], &g = s.parameters[1], &D = s.parameters[2];
    const Real d = s.q[0], d1 = s.qdot[0], &pd = s.qdot[1], &td = s.qdot[2];
    const Real d2 = -s.parameters[4] * s.parameters[5] * s.parameters[5] * cln::sin(s.parameters[5] * s.t);
    const Real sp = cln::sin(s.q[1]), cp = cln::cos(s.q[1]);
    CHECK(near(s.qddot[0], d2, 55));
    CHECK(near(s.qddot[1], td * td * sp * cp + g * sp / d - 2 * d1 * pd / d, 55));
    CHECK(near(s.qddot[2], D / (mass * sp) - 2 * d1 * td / d - 2 * pd * td * cp / sp, 55));
    CHECK(near(motion.lambda[0], mass * (d2 - d * pd * pd - d * sp * sp * td * td + g * cp), 55));
  }
}

TEST_CASE("solve: pivots, scales over many orders of magnitude, and detects a singular matrix") {
  const Precision p(60);
  const auto r = [&](double value) { return p.round(cln::rational(Real(value))); };
  // [0 1e20; 1e-20 1] x = [1e20; 3]
  const Solution good = solve({Real(0), r(1e20), r(1e-20), r(1)}, std::vector<Real>{r(1e20), r(3)});
  REQUIRE(good.exists());
  CHECK(near(good.x()[1], 1, 55));
  CHECK(near(good.x()[0], 2 / r(1e-20), 55));
  CHECK(!solve({r(1), r(2), r(2), r(4)}, std::vector<Real>{r(1), r(1)}).exists());
  const Real beyond = r(1e300) * r(1e300);  // the range of binary64
  const Solution large = solve({beyond, Real(0), Real(0), 1 / beyond}, std::vector<Real>{2 * beyond, 3 / beyond});
  REQUIRE(large.exists());
  CHECK(near(large.x()[0], 2, 55));
  CHECK(near(large.x()[1], 3, 55));
}

TEST_CASE(
    "solve: entries beyond the range of binary64, products of starts of 1e-300 or speeds of 1e300, are scaled all "
    "the same") {
  const Precision p(60);
  const auto r = [&](double value) { return p.round(cln::rational(Real(value))); };
  for (const double scale : {1e-300, 1e-160, 1e160, 1e300}) {
    const Real s = r(scale) * r(scale);
    const Solution found = solve({2 * s, s, s, 3 * s}, std::vector<Real>{3 * s, 4 * s});
    REQUIRE(found.exists());
    CHECK(near(found.x()[0], 1, 55));
    CHECK(near(found.x()[1], 1, 55));
  }
}

TEST_CASE("solve: large systems, as a whole or in decoupled blocks, have all digits") {
  const Precision p(60);
  const auto entry = [&](std::size_t i, std::size_t k) {
    return p.round(Real(1) / (1 + static_cast<int>((7 * i + 3 * k) % 11)) + (i == k ? 5 : 0));
  };
  for (const std::size_t part : {std::size_t{40}, std::size_t{20}, std::size_t{1}}) {  // blocks of this size
    constexpr std::size_t n = 40;
    std::vector<Real> A(n * n, Real(0)), b(n, Real(0));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) {
        if (i / part != k / part) continue;
        A[i * n + k] = entry(i, k) * cln::expt(Real(2), cln::cl_I(static_cast<int>(i) - 2 * static_cast<int>(k)));
        b[i] = b[i] + A[i * n + k] * p.round(Real(static_cast<int>(k) + 1) / 7);
      }
    const Solution found = solve(A, b, true);
    REQUIRE(found.exists());
    for (std::size_t k = 0; k < n; ++k) CHECK(near(found.x()[k], p.round(Real(static_cast<int>(k) + 1) / 7), 54));
    for (const std::size_t column : {std::size_t{0}, n - 1}) {  // sizes of the inverse
      std::vector<Real> unit(n, Real(0));
      unit[column] = 1;
      const Solution inverse = solve(A, unit);
      for (std::size_t i = 0; i < n; ++i) {
        const double size = std::fabs(cln::double_approx(inverse.x()[i]));
        CHECK(std::fabs(cln::double_approx(found.inverse[column][i]) - size) <= 1e-9 * size);
      }
    }
  }
}
