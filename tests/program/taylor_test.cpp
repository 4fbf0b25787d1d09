// SPDX-License-Identifier: GPL-3.0-or-later
// The recurrences of Taylor series compared with the right-hand side. A polynomial of order p that follows the motion
// has a residual x' - f(t, x) of order p. A wrong coefficient of order k causes a residual of order k - 1.
#include "program/taylor.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "error.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

constexpr int digits = 70;

using Number = cln::cl_R;

/// c[k][i] from the interpreter, with the sums of products from their definition.
std::vector<std::vector<Number>> coefficients(const program::Taylor& taylor, const program::Arguments<Number>& at,
                                              int order) {
  const auto start = program::interpret(taylor.start, at, digits).results;
  std::vector<std::vector<Number>> c{at.x, start[1]}, a(1), b(1);
  for (int k = 1; k < order; ++k) {
    program::Arguments<Number> next{k, c.back(), {}, {}};
    next.w = start[0];
    for (std::size_t i = 0; i < taylor.product_count; ++i) {
      Number sum = 0;
      for (std::size_t j = 1; j < static_cast<std::size_t>(k); ++j)
        sum = sum + a[j][i] * b[static_cast<std::size_t>(k) - j][i];
      next.w.push_back(sum);
    }
    next.w.push_back(k == 1 ? 1 : 0);
    next.w.push_back(cln::cl_RA(1) / k);
    auto results = program::interpret(taylor.next, next, digits).results;
    a.push_back(results[0]);
    b.push_back(results[1]);
    for (Number& value : results[2]) value = value / (k + 1);
    c.push_back(results[2]);
  }
  return c;
}

/// Largest |x' - f| of the polynomial at t + tau.
double residual(const program::Function& rhs, const std::vector<std::vector<Number>>& c, program::Arguments<Number> at,
                const Number& tau) {
  std::vector<Number> rate(at.x.size(), 0);
  for (std::size_t i = 0; i < at.x.size(); ++i) {
    Number x = 0;
    for (std::size_t k = c.size(); k-- > 0;) {
      x = x * tau + c[k][i];
      if (k > 0) rate[i] = rate[i] * tau + static_cast<int>(k) * c[k][i];
    }
    at.x[i] = x;
  }
  at.t = at.t + tau;
  const auto f = program::interpret(rhs, at, digits).results[0];
  double largest = 0;
  for (std::size_t i = 0; i < f.size(); ++i) largest = std::max(largest, std::abs(cln::double_approx(rate[i] - f[i])));
  return largest;
}

void follows_the_motion(const system::EquationSystem& system, std::uint64_t point) {
  const auto built = build(system, {"taylor"});
  REQUIRE(built.taylor.has_value());
  const auto at = arguments_at<Number>(system, point);
  constexpr int order = 9;
  const auto c = coefficients(*built.taylor, at, order);
  const Number tau = cln::expt(cln::cl_RA(10), -4);
  const double coarse = residual(built.functions[0], c, at, tau), fine = residual(built.functions[0], c, at, tau / 4);
  CHECK(coarse < 1e-20);
  if (coarse > 1e-55)
    CHECK(std::log2(coarse / fine) / 2 == doctest::Approx(order).epsilon(0.02));  // terms of the next order: tau
}

/// The right-hand side of qddot = g for one coordinate.
system::EquationSystem one(const std::function<Scalar(const SystemBuilder&)>& g) {
  const SystemBuilder k;
  system::EquationSystem system;
  system.dag = k.dag;
  system.formulation = "lagrange";
  system.free = {0};
  system.M = {k.dag->one()};
  system.f = {g(k).ref};
  return system;
}

}  // namespace

TEST_CASE("taylor: the recurrences of mechanical systems, including the solve") {
  for (const auto& system :
       {pendulum(), double_pendulum(), cart_pendulum(), spherical_pendulum(), massless_coordinate(), chain(3)}) {
    CAPTURE(system.free.size());
    for (const std::uint64_t point : std::initializer_list<std::uint64_t>{1, 4}) follows_the_motion(system, point);
  }
}

TEST_CASE("taylor: the recurrence of every operation") {
  const auto call = [](Op op) {
    return [op](const SystemBuilder& k) {
      return k.s(k.dag->call(op, (k.q(0) * k.number(2, 3) + k.q(0, 1) * k.t() * k.number(1, 7)).ref));
    };
  };
  for (const Op op : {Op::sqrt, Op::sin, Op::cos, Op::tan, Op::atan, Op::sinh, Op::cosh, Op::tanh, Op::exp, Op::log,
                      Op::abs, Op::sign}) {
    CAPTURE(static_cast<int>(op));
    follows_the_motion(one(call(op)), 2);
  }
  for (const Op op : {Op::asin, Op::acos}) {  // inside their domain
    follows_the_motion(
        one([op](const SystemBuilder& k) { return k.s(k.dag->call(op, (k.q(0) * k.t() * k.number(1, 3)).ref)); }), 2);
  }
  for (const Op op : {Op::atan2, Op::min, Op::max}) {
    CAPTURE(static_cast<int>(op));
    follows_the_motion(
        one([op](const SystemBuilder& k) { return k.s(k.dag->call(op, k.q(0).ref, (k.q(0, 1) * k.t()).ref)); }), 2);
    follows_the_motion(one([op](const SystemBuilder& k) { return k.s(k.dag->call(op, k.q(0).ref, k.p(0).ref)); }), 2);
    follows_the_motion(one([op](const SystemBuilder& k) { return k.s(k.dag->call(op, k.p(0).ref, k.q(0).ref)); }), 3);
  }
}

TEST_CASE("taylor: powers, quotients and branches of varying and constant values") {
  const auto pow = [](const SystemBuilder& k, Scalar a, Scalar b) { return k.s(k.dag->pow(a.ref, b.ref)); };
  const std::vector<std::function<Scalar(const SystemBuilder&)>> list = {
      [&](const SystemBuilder& k) { return pow(k, k.q(0), k.p(0)); },
      [&](const SystemBuilder& k) { return pow(k, k.p(0), k.q(0)); },
      [&](const SystemBuilder& k) { return pow(k, k.q(0), k.q(0, 1)); },
      [&](const SystemBuilder& k) { return pow(k, k.q(0) * k.t(), k.number(7, 3)); },
      [&](const SystemBuilder& k) { return k.q(0) / k.p(0) + k.p(1) / k.q(0) + k.q(0) / k.q(0, 1); },
      [&](const SystemBuilder& k) {
        return k.number(1) / (k.q(0) * k.q(0) * k.q(0)) - k.q(0) * k.q(0, 1) * k.p(2) * k.t();
      },
      [&](const SystemBuilder& k) {
        return k.s(k.dag->select(k.q(0).ref, k.p(0).ref, (k.q(0) * k.q(0)).ref, k.sin(k.q(0, 1)).ref));
      },
      [&](const SystemBuilder& k) {
        return k.s(k.dag->select(k.p(0).ref, k.q(0).ref, (k.q(0) * k.q(0)).ref, k.p(1).ref));
      },
      [&](const SystemBuilder& k) { return k.sin(k.q(0)) * k.cos(k.q(0, 1)) + k.cos(k.q(0)) + k.t() * k.t(); },
      [&](const SystemBuilder& k) { return k.p(0) * k.q(0) + k.u(0); }};
  for (std::size_t i = 0; i < list.size(); ++i) {
    CAPTURE(i);
    follows_the_motion(one(list[i]), 2);
    follows_the_motion(one(list[i]), 5);
  }
}

TEST_CASE("taylor: a program that is too large for series is rejected") {
  const auto built = build(chain(2));
  program::Function huge = built.functions[0];
  const auto square =
      program::Instruction{Op::mul, {{program::Slot::state, 0}, {program::Slot::state, 0}}, 0, "", "", 0, 0};
  for (std::uint32_t i = 0; i < 12000; ++i) {
    huge.code.push_back(square);
    huge.code.back().operands[1] = {program::Slot::value, static_cast<std::uint32_t>(huge.code.size() - 2)};
  }
  const std::size_t products = program::taylor_series(huge).product_count;
  CHECK(products == program::taylor_series(built.functions[0]).product_count);  // nothing depends on them
  huge.results[0].entries[0] = {program::Slot::value, static_cast<std::uint32_t>(huge.code.size() - 1)};
  CHECK_THROWS_WITH_AS(program::taylor_series(huge), doctest::Contains("too large for Taylor series"), Error);
}
