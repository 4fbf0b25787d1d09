// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <functional>

#include "error.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

TEST_CASE("program: the Jacobian agrees with difference quotients of the right-hand side to 20 digits") {
  for (const auto& system :
       {double_pendulum(), cart_pendulum(), spherical_pendulum(), massless_coordinate(), chain(3)}) {
    CAPTURE(system.free.size());
    const auto built = build(system, {"jac", "jac_p"});
    const auto base = arguments_at<cln::cl_R>(system, 1);
    const auto jac = program::interpret(built.functions[1], base, 60).results;
    const auto jac_p = program::interpret(built.functions[2], base, 60).results[0];
    const std::size_t n = 2 * system.free.size();
    const cln::cl_R step = cln::expt(cln::cl_RA(10), -15);
    const auto quotient = [&](const std::function<cln::cl_R&(program::Arguments<cln::cl_R>&)>& pick) {
      auto above = base, below = base;
      pick(above) = pick(above) + step;
      pick(below) = pick(below) - step;
      auto result = program::interpret(built.functions[0], above, 60).results[0];
      const auto other = program::interpret(built.functions[0], below, 60).results[0];
      for (std::size_t i = 0; i < n; ++i) result[i] = (result[i] - other[i]) / (2 * step);
      return result;
    };
    const auto column = [n](const std::vector<cln::cl_R>& all, std::size_t j) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(j * n);
      return std::vector<cln::cl_R>(begin, begin + static_cast<std::ptrdiff_t>(n));
    };
    for (std::size_t j = 0; j < n; ++j) {
      CHECK(difference(column(jac[0], j), quotient([j](auto& a) -> cln::cl_R& { return a.x[j]; })) <
            tolerances::difference_quotient);
    }
    CHECK(difference(jac[1], quotient([](auto& a) -> cln::cl_R& { return a.t; })) < tolerances::difference_quotient);
    for (std::size_t j = 0; j < jac_p.size() / n; ++j) {
      CHECK(difference(column(jac_p, j), quotient([j](auto& a) -> cln::cl_R& { return a.p[j]; })) <
            tolerances::difference_quotient);
    }
  }
}

TEST_CASE("program: h of `mass` closes M qddot + h = A^T lambda") {
  const auto system = spherical_pendulum();
  const auto built = build(system, {"mass", "constraints", "reactions"});
  const auto arguments = arguments_at<double>(system, 2);
  const auto dx = program::interpret(built.functions[0], arguments).results[0];
  const auto mass = program::interpret(built.functions[1], arguments).results;
  const auto constraints = program::interpret(built.functions[2], arguments).results;
  const auto lambda = program::interpret(built.functions[3], arguments).results[0];
  for (std::size_t i = 0; i < 3; ++i) {
    double left = mass[1][i];
    for (std::size_t j = 0; j < 3; ++j) left += mass[0][i + 3 * j] * dx[3 + j];
    CHECK(left == doctest::Approx(constraints[1][i] * lambda[0]).epsilon(tolerances::unrolled_solve));
  }
}

TEST_CASE("program: a function computes only what it needs") {
  const auto built = build(spherical_pendulum(), {"mass"}, true, true);
  CHECK(built.functions[1].name == "mass");
  CHECK(built.functions[1].operations.div == 0);
  CHECK(built.functions[1].operations.sqrt == 0);
  CHECK(built.functions[1].pivots.empty());
  std::vector<system::EquationSystem> candidates{cart_pendulum()};
  program::Request request;
  request.outputs = {"potential"};
  const auto potential = program::build_program(candidates, request).functions[1];
  CHECK(potential.operations.trig == 1);
  CHECK(potential.operations.flops() <= 3);
  CHECK_FALSE(potential.uses_input);
}

TEST_CASE("program: fixed parameters become numbers and fold") {
  std::vector<system::EquationSystem> candidates{pendulum()};
  program::Request request;
  request.fix = {{1, symbolic::Rational(1) / 2}, {2, symbolic::Rational(981) / 100}};
  const auto function = program::build_program(candidates, request).functions[0];
  CHECK(function.operations.mul == 1);  // 19.62 sin theta
  CHECK(function.operations.div == 0);
  REQUIRE(function.constants.size() == 1);
  CHECK(function.constants[0] == symbolic::Rational(981) / 50);
  CHECK(function.pivots.empty());
}

TEST_CASE("program: the cheapest formulation is selected, the first in a tie, and expensive ones are not optimised") {
  std::vector<system::EquationSystem> candidates{chain(2), double_pendulum()};
  candidates[0].formulation = "first";
  candidates[1].formulation = "second";
  auto built = program::build_program(candidates, {});
  CHECK(built.formulation == "second");
  REQUIRE(built.candidates.size() == 2);
  CHECK(built.candidates[0].formulation == "first");
  CHECK(built.candidates[1].operations.cost() <= built.candidates[0].operations.cost());
  CHECK(built.functions[0].operations.cost() == built.candidates[1].operations.cost());
  candidates = {double_pendulum(), double_pendulum()};
  candidates[0].formulation = "first";
  candidates[1].formulation = "second";
  CHECK(program::build_program(candidates, {}).formulation == "first");
}

TEST_CASE("program: unknown functions and outputs are rejected by name") {
  const auto message = [](const std::vector<std::string>& with,
                          const std::vector<std::string>& outputs) -> std::string {
    std::vector<system::EquationSystem> candidates{pendulum()};
    program::Request request;
    request.with = with;
    request.outputs = outputs;
    try {
      program::build_program(candidates, request);
    } catch (const Error& error) {
      return error.message() + " / " + error.remedy();
    }
    return "";
  };
  CHECK(message({"rhs_batch"}, {}) ==
        "there is no function `rhs_batch` / available functions: jac, jac_p, jac_u, jvp, vjp, adjoint, hvp, inverse, "
        "regressor, coriolis, gravity, mass, momenta, momenta_jac, momenta_jac_p, momenta_jac_u, energy_gradients, "
        "momentum, constraints, reactions, "
        "reactions_jac, reactions_jac_p, reactions_jac_u, outputs, outputs_jac, outputs_jac_p, outputs_jac_u, events, "
        "contact_rows, rhs_open, power, resets, frames, taylor");
  CHECK(message({"jacobian"}, {}).starts_with("there is no function `jacobian`"));
  CHECK(message({}, {"energie"}) == "there is no output `energie` / outputs of this model: energy, kinetic, potential");
}

TEST_CASE("program: the right-hand side of open contacts reads none of their forces, and takes less work") {
  system::EquationSystem system = pendulum();
  Dag& dag = *system.dag;
  const Symbol force{SymbolKind::friction, 0, 0}, input{SymbolKind::input, 0, 0};
  const SystemBuilder k{system.dag};
  const Scalar push = k.s(dag.symbol(force)), given = k.u(1);
  system.f[0] = (k.s(system.f[0]) + push * k.cos(k.q(0)) + given).ref;
  system.power = ((push * k.cos(k.q(0)) + given) * k.q(0, 1)).ref;
  system.contact_inputs[force] = input;
  program::Program built = build(system, {"rhs_open", "power"});
  CHECK(built.open_saves_work());
  const program::Function &rhs = built.functions[0], &open = built.functions[1], &power = built.functions[2];
  auto pushed = arguments_at<double>(system, 3), without = pushed;
  without.u[0] = 0;
  const auto expected = program::interpret(rhs, without).results[0];
  const auto found = program::interpret(open, pushed).results;
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(found[0][i] == doctest::Approx(expected[i]).epsilon(tolerances::unrolled_solve));
  CHECK(found[1][0] == doctest::Approx(without.u[1] * without.x[1]).epsilon(tolerances::unrolled_solve));
  CHECK(program::interpret(power, without).results[0][0] == doctest::Approx(found[1][0]));
  CHECK(program::interpret(power, pushed).results[0][0] != doctest::Approx(found[1][0]));
  built.functions.erase(built.functions.begin() + 1);
  CHECK_FALSE(built.open_saves_work());
}

TEST_CASE("program: an expression that does not follow from the state is rejected") {
  auto system = pendulum();
  const SystemBuilder k{system.dag};
  system.f[0] = k.s(k.dag->symbol({symbolic::SymbolKind::function, 0, 0})).ref;
  CHECK_THROWS_AS(build(system), Error);
}
