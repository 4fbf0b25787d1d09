// SPDX-License-Identifier: GPL-3.0-or-later
// Comparison of the unrolled solve with Eigen at random points.
#include "program/linear_solver.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include "error.hpp"
#include "program/abi_functions.hpp"
#include "program/null_space_solver.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

double number(const cln::cl_R& x) { return cln::double_approx(x); }

Eigen::MatrixXd matrix(const system::EquationSystem& s, const std::vector<symbolic::Ref>& entries, std::size_t rows,
                       std::size_t columns, std::uint64_t point) {
  const auto values = expressions_at(*s.dag, entries, point);
  Eigen::MatrixXd result(rows, columns);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = number(values[i * columns + j]);
    }
  }
  return result;
}

/// Accelerations, then multipliers, from [M -A^T; A 0] (qddot, lambda) = (f, -gamma).
Eigen::VectorXd reference(const system::EquationSystem& s, std::uint64_t point) {
  const std::size_t n = s.free.size(), m = s.active.size();
  const auto rows = static_cast<Eigen::Index>(n), below = static_cast<Eigen::Index>(m);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(rows + below, rows + below);
  Eigen::VectorXd r(rows + below);
  K.topLeftCorner(rows, rows) = matrix(s, s.M, n, n, point);
  r.head(rows) = matrix(s, s.f, n, 1, point);
  if (m > 0) {
    const Eigen::MatrixXd A = matrix(s, s.A, m, n, point);
    K.topRightCorner(rows, below) = -A.transpose();
    K.bottomLeftCorner(below, rows) = A;
    r.tail(below) = -matrix(s, s.gamma, m, 1, point);
  }
  return K.fullPivLu().solve(r);
}

void check_against_eigen(const system::EquationSystem& system) {
  for (std::uint64_t point = 0; point < 5; ++point) {
    const Eigen::VectorXd expected = reference(system, point);
    const program::Program built = build(system, {"reactions"});
    const auto arguments = arguments_at<double>(system, point);
    const auto dx = program::interpret(built.functions[0], arguments).results[0];
    const auto lambda = program::interpret(built.functions[1], arguments).results[0];
    const std::size_t n = system.free.size();
    const double scale = expected.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < n; ++i) {
      CHECK(dx[i] == arguments.x[n + i]);
      CHECK(std::abs(dx[n + i] - expected(static_cast<Eigen::Index>(i))) <= tolerances::unrolled_solve * scale);
    }
    for (std::size_t k = 0; k < system.active.size(); ++k) {
      CHECK(std::abs(lambda[k] - expected(static_cast<Eigen::Index>(n + k))) <= tolerances::unrolled_solve * scale);
    }
  }
}

}  // namespace

TEST_CASE("solve: accelerations agree with Eigen for dense and diagonal mass matrices") {
  check_against_eigen(pendulum());
  check_against_eigen(double_pendulum());
  check_against_eigen(cart_pendulum());
  check_against_eigen(chain(5));
}

TEST_CASE("solve: with constraints accelerations and multipliers solve the KKT system") {
  check_against_eigen(spherical_pendulum());
}

TEST_CASE("solve: a massless coordinate that a constraint determines leaves the multipliers unchanged") {
  const auto system = massless_coordinate();
  CHECK(program::is_singular_everywhere(*system.dag, system.M, 3));
  check_against_eigen(system);
}

TEST_CASE("solve: an undetermined massless coordinate is rejected") {
  auto system = massless_coordinate();
  system.active.clear();
  system.A.clear();
  system.psi.clear();
  system.b.clear();
  system.gamma.clear();
  CHECK_THROWS_AS(build(system), Error);
}

TEST_CASE("solve: structural zeros of M cost no operations") {
  // Two independent pendulums: no operation couples them.
  const SystemBuilder k;
  const Scalar half = k.number(1, 2), l = k.p(0), g = k.p(1);
  Scalar T = k.number(0), V = k.number(0);
  for (std::uint32_t i = 0; i < 2; ++i) {
    T = T + half * l * l * k.q(i, 1) * k.q(i, 1);
    V = V - g * l * k.cos(k.q(i));
  }
  const auto built = build(lagrange(k, 2, T, V, {k.number(0), k.number(0)}));
  CHECK(built.functions[0].operations.add == 0);
  CHECK(built.functions[0].operations.div == 1);  // g/l, shared
  CHECK(built.functions[0].operations.mul == 2);
}

TEST_CASE("solve: the order of elimination preserves the zeros of an arrow-shaped M") {
  // One cart with four pendulums: M is an arrow matrix. In minimum degree order the pendulums come first and there is
  // no fill-in.
  const SystemBuilder k;
  const Scalar half = k.number(1, 2), m = k.p(0), l = k.p(1), g = k.p(2);
  Scalar T = half * m * k.q(0, 1) * k.q(0, 1), V = k.number(0);
  constexpr std::uint32_t pendulums = 4;
  for (std::uint32_t i = 1; i <= pendulums; ++i) {
    const Scalar w = k.q(i, 1), v = k.q(0, 1);
    T = T + half * m * (v * v + k.number(2) * l * v * w * k.cos(k.q(i)) + l * l * w * w);
    V = V - m * g * l * k.cos(k.q(i));
  }
  const auto system = lagrange(k, 1 + pendulums, T, V, std::vector<Scalar>(1 + pendulums, k.number(0)));
  check_against_eigen(system);
  // 8 flops per pendulum for elimination and back substitution; a filled matrix would take far more
  CHECK(build(system).functions[0].operations.flops() <= 60);
}

TEST_CASE("solve: the pivot test detects exactly the singular matrices") {
  // At theta2 - theta1 = 0 with m1 = 0 the mass matrix of the double pendulum is exactly singular.
  const auto system = double_pendulum();
  const auto built = build(system);
  const auto vanishes = [&](double m1, double difference) {
    auto arguments = arguments_at<double>(system, 0);
    arguments.p[0] = m1;
    arguments.x[1] = arguments.x[0] + difference;
    bool any = false;
    const auto values = program::interpret(built.functions[0], arguments);
    for (const auto& [pivot, scale] : values.pivots) {
      any = any || std::abs(pivot) <= program::pivot_tolerance * std::abs(scale);
    }
    return any;
  };
  CHECK(vanishes(0, 0));
  CHECK_FALSE(vanishes(1e-6, 0));
  CHECK_FALSE(vanishes(0, 0.01));
}

TEST_CASE(
    "the null space and Chaplygin forms agree with the full system, multipliers included, also without inertia in one "
    "direction") {
  const SystemBuilder k;
  const auto square = [](Scalar x) { return x * x; };
  for (const bool massless : {false, true}) {
    Scalar T = k.number(1, 2) * (k.p(0) * square(k.q(0, 1)) + k.p(1) * square(k.q(1, 1)) +
                                 k.q(0) * k.q(0, 1) * k.q(2, 1) + k.number(2) * square(k.q(2, 1)));
    if (!massless) T = T + square(k.q(3, 1)) * k.p(0);
    system::EquationSystem system =
        lagrange(k, 4, T, k.p(2) * k.q(0) * k.q(3) + square(k.q(1)), {k.q(1), k.number(1), k.q(0, 1), k.q(2)});
    constrain(system, k, "a", k.q(0) * k.q(1) + square(k.q(3)) + k.q(2) * k.p(1));
    for (const bool second : {false, true}) {
      if (second) constrain(system, k, "b", k.cos(k.q(0)) + k.q(1) * k.q(3) - k.q(2));
      for (const system::Form form : {system::Form::nullspace, system::Form::chaplygin}) {
        system.form = form;
        REQUIRE(program::is_form_applicable(system, form, false));
        check_against_eigen(system);
      }
    }
  }
}

TEST_CASE("dependent columns are chosen at points on the constraints") {
  // In the row (q1, q0 + p0) the first entry is shorter, and it is 0 wherever q1 (q0 + p0) = 0 holds near q1 = 0.
  const SystemBuilder k;
  Scalar T = k.number(0);
  for (std::uint32_t i = 0; i < 3; ++i) T = T + k.p(1) * k.q(i, 1) * k.q(i, 1);
  system::EquationSystem system = lagrange(k, 3, T, k.q(0) + k.q(2), {k.number(0), k.number(0), k.number(0)});
  constrain(system, k, "product", k.q(1) * (k.q(0) + k.p(0)));
  const auto blocks = program::dependent_blocks(system);
  REQUIRE(blocks.has_value());
  REQUIRE(blocks->size() == 1);
  CHECK(blocks->front().dependent == std::vector<std::size_t>{1});
  system::EquationSystem without = lagrange(k, 3, T, k.q(0) + k.q(2), {k.number(0), k.number(0), k.number(0)});
  constrain(without, k, "velocity", k.q(1) * (k.q(0) + k.p(0)));
  without.holonomic = {false};
  const auto free = program::dependent_blocks(without);
  REQUIRE(free.has_value());
  CHECK(free->front().dependent == std::vector<std::size_t>{0});  // a velocity constraint holds at every position
}

TEST_CASE("rows that are dependent everywhere on the constraints have no dependent columns") {
  // Elsewhere every determinant is a multiple of the first psi.
  const SystemBuilder k;
  Scalar T = k.number(0);
  for (std::uint32_t i = 0; i < 4; ++i) T = T + k.p(0) * k.q(i, 1) * k.q(i, 1);
  const Scalar none = k.number(0), psi = k.q(2) + k.q(0) * k.q(0);
  system::EquationSystem system = lagrange(k, 4, T, k.q(0) + k.q(3), {none, none, none, none});
  constrain(system, k, "a", psi);
  constrain(system, k, "again", psi * (k.number(1) + k.q(1)));
  CHECK_FALSE(program::dependent_blocks(system).has_value());
  for (const system::Form form : {system::Form::nullspace, system::Form::chaplygin}) {
    system.form = form;
    CHECK_FALSE(program::is_form_applicable(system, form, false));
    CHECK_THROWS_AS(program::make_linear_solver(system, program::Ties::ascending), Error);
  }
}

TEST_CASE(
    "forms that hold everywhere: blocks with one column more than rows, or with a determinant that cannot vanish") {
  const SystemBuilder k;
  const auto square = [](Scalar x) { return x * x; };
  const Scalar T = square(k.q(0, 1)) + square(k.q(1, 1)) + square(k.q(2, 1));
  system::EquationSystem two = lagrange(k, 3, T, k.number(0), {k.number(0), k.number(0), k.number(0)});
  constrain(two, k, "a", square(k.q(0)) + square(k.q(1)));
  CHECK(program::is_form_applicable(two, system::Form::nullspace, true));
  CHECK_FALSE(program::is_form_applicable(two, system::Form::chaplygin, true));
  CHECK(program::is_form_applicable(two, system::Form::chaplygin, false));
  system::EquationSystem three = lagrange(k, 3, T, k.number(0), {k.number(0), k.number(0), k.number(0)});
  constrain(three, k, "a", square(k.q(0)) + square(k.q(1)) + square(k.q(2)));
  CHECK_FALSE(program::is_form_applicable(three, system::Form::nullspace, true));
  system::EquationSystem linear = lagrange(k, 3, T, k.number(0), {k.number(0), k.number(0), k.number(0)});
  constrain(linear, k, "a", square(k.q(0)) + square(k.q(1)) + k.q(2));
  CHECK(program::is_form_applicable(linear, system::Form::nullspace, true));
  CHECK(program::is_form_applicable(linear, system::Form::chaplygin, true));
}
