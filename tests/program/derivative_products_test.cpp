// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "program/abi_functions.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

using Numbers = std::vector<cln::cl_R>;

constexpr int product_digits = 60;

Numbers vector_of(std::size_t size, long first) {
  Numbers result;
  for (std::size_t i = 0; i < size; ++i) result.push_back(cln::cl_RA(static_cast<long>(5 * i % 7) - first) / 4);
  return result;
}

/// Rows of a matrix that is stored by columns, times a vector.
Numbers times(const Numbers& matrix, const Numbers& v) {
  const std::size_t rows = matrix.size() / v.size();
  Numbers result(rows, cln::cl_R(0));
  for (std::size_t j = 0; j < v.size(); ++j)
    for (std::size_t i = 0; i < rows; ++i) result[i] = result[i] + matrix[i + rows * j] * v[j];
  return result;
}
/// A vector times the columns of a matrix.
Numbers times_columns(const Numbers& v, const Numbers& matrix) {
  Numbers result;
  for (std::size_t j = 0; j < matrix.size() / v.size(); ++j) {
    cln::cl_R sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum = sum + v[i] * matrix[i + v.size() * j];
    result.push_back(sum);
  }
  return result;
}

}  // namespace

TEST_CASE("derivative products: they are products with the Jacobian, by either way") {
  for (const auto& system :
       {double_pendulum(), cart_pendulum(), spherical_pendulum(), massless_coordinate(), chain(3)}) {
    CAPTURE(system.free.size());
    const std::size_t states = 2 * system.free.size();
    const auto at = arguments_at<cln::cl_R>(system, 1);
    const Numbers v(at.v.begin(), at.v.begin() + static_cast<std::ptrdiff_t>(states));
    const auto derivatives = build(system, {"jac", "jac_p"});
    const Numbers jac = program::interpret(derivatives.functions[1], at, product_digits).results[0],
                  jac_p = program::interpret(derivatives.functions[2], at, product_digits).results[0];
    for (const bool optimise : {false, true}) {
      CAPTURE(optimise);
      const auto built = build(system, {"jvp", "vjp", "adjoint"}, optimise);
      const auto values = [&](std::size_t k) {
        return program::interpret(built.functions[k], at, product_digits).results;
      };
      CHECK(difference(values(1)[0], times(jac, v)) < tolerances::same_value);
      CHECK(difference(values(2)[0], times_columns(v, jac)) < tolerances::same_value);
      CHECK(difference(values(3)[0], times_columns(v, jac)) < tolerances::same_value);
      CHECK(difference(values(3)[1], times_columns(v, jac_p)) < tolerances::same_value);
    }
    for (const auto by : {program::Differentiate::equations, program::Differentiate::solution}) {
      program::AbiFunctions functions(system, {});
      const auto value = [&](const program::FunctionExpressions& wanted) {
        return expressions_at(*system.dag, wanted.results[0].entries, 1);
      };
      CHECK(difference(value(functions.jvp(by)), times(jac, v)) < tolerances::same_value);
      CHECK(difference(value(functions.vjp(by)), times_columns(v, jac)) < tolerances::same_value);
    }
  }
}

TEST_CASE("derivative products: hvp is symmetric, and the slope of vjp") {
  for (const auto& system : {double_pendulum(), cart_pendulum(), spherical_pendulum()}) {
    CAPTURE(system.free.size());
    const std::size_t states = 2 * system.free.size();
    auto at = arguments_at<cln::cl_R>(system, 1);
    const Numbers c = vector_of(states, 2), d = vector_of(states, 1), e = vector_of(states, 5);
    const auto built = build(system, {"vjp", "hvp"});
    const auto hessian = [&](const Numbers& direction) {
      at.v = c;
      at.v.insert(at.v.end(), direction.begin(), direction.end());
      return program::interpret(built.functions[2], at, product_digits).results[0];
    };
    CHECK(difference(times_columns(e, hessian(d)), times_columns(d, hessian(e))) < tolerances::same_value);
    const Numbers got = hessian(d);
    const cln::cl_R step = cln::expt(cln::cl_RA(10), -15);
    const auto moved = [&](const cln::cl_R& h) {
      auto there = at;
      for (std::size_t i = 0; i < states; ++i) there.x[i] = there.x[i] + h * d[i];
      return program::interpret(built.functions[1], there, product_digits).results[0];
    };
    Numbers slope = moved(step);
    const Numbers below = moved(-step);
    for (std::size_t i = 0; i < states; ++i) slope[i] = (slope[i] - below[i]) / (2 * step);
    CHECK(difference(got, slope) < tolerances::difference_quotient);
  }
}

TEST_CASE("derivative products: inverse dynamics of the accelerations is what constraints add") {
  for (const auto& system : {double_pendulum(), spherical_pendulum(), chain(3)}) {
    const std::size_t n = system.free.size();
    auto at = arguments_at<cln::cl_R>(system, 1);
    const auto built = build(system, {"inverse", "constraints", "reactions"});
    const Numbers dx = program::interpret(built.functions[0], at, product_digits).results[0];
    at.v.assign(dx.begin() + static_cast<std::ptrdiff_t>(n), dx.begin() + static_cast<std::ptrdiff_t>(2 * n));
    const Numbers tau = program::interpret(built.functions[1], at, product_digits).results[0];
    const auto constraints = program::interpret(built.functions[2], at, product_digits).results;
    Numbers lambda = program::interpret(built.functions[3], at, product_digits).results[0];
    Numbers forces(n, cln::cl_R(0));
    if (!lambda.empty()) forces = times_columns(lambda, constraints[1]);
    cln::cl_R largest = 1;
    for (const cln::cl_R& force : tau) largest = cln::max(largest, cln::abs(force));
    for (std::size_t i = 0; i < n; ++i)
      CHECK(cln::double_approx(cln::abs(tau[i] - forces[i]) / largest) < tolerances::same_value);
  }
}

TEST_CASE("derivative products: dM/dt - 2 C is skew, and C qdot with the gradient of U is h") {
  const auto system = double_pendulum();
  const std::size_t n = system.free.size();
  const auto at = arguments_at<cln::cl_R>(system, 2);
  const auto built = build(system, {"coriolis", "gravity", "mass"});
  const Numbers C = program::interpret(built.functions[1], at, product_digits).results[0],
                g = program::interpret(built.functions[2], at, product_digits).results[0];
  const Numbers qdot(at.x.begin() + static_cast<std::ptrdiff_t>(n), at.x.end());
  const cln::cl_R step = cln::expt(cln::cl_RA(10), -15);
  const auto mass_at = [&](const cln::cl_R& h) {
    auto there = at;
    for (std::size_t i = 0; i < n; ++i) there.x[i] = there.x[i] + h * qdot[i];
    return program::interpret(built.functions[3], there, product_digits).results;
  };
  const Numbers high = mass_at(step)[0], low = mass_at(-step)[0], h = mass_at(0)[1];
  Numbers slope, both;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      slope.push_back((high[i + n * j] - low[i + n * j]) / (2 * step));
      both.push_back(C[i + n * j] + C[j + n * i]);
    }
  }
  CHECK(difference(slope, both) < tolerances::difference_quotient);
  Numbers sum = times(C, qdot);
  for (std::size_t i = 0; i < n; ++i) sum[i] = sum[i] + g[i];
  CHECK(difference(sum, h) < tolerances::same_value);
}
