// SPDX-License-Identifier: GPL-3.0-or-later
// The optimiser compared with its source expressions, and the operation counts that it achieves.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "program/abi_functions.hpp"
#include "program/from_dag.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

std::vector<NamedSystem> systems() {
  std::vector<NamedSystem> list;
  list.push_back({"pendulum", pendulum()});
  list.push_back({"double pendulum", double_pendulum()});
  list.push_back({"cart and pendulum", cart_pendulum()});
  list.push_back({"spherical pendulum", spherical_pendulum()});
  list.push_back({"massless", massless_coordinate()});
  list.push_back({"chain of 3", chain(3)});
  list.push_back({"chain of 6", chain(6)});
  return list;
}

/// A random expression of three coordinates with all kinds of nodes.
symbolic::Ref random_expression(SystemBuilder& k, std::uint64_t seed) {
  symbolic::Dag& dag = *k.dag;
  std::vector<symbolic::Ref> refs;
  for (std::uint32_t i = 0; i < 3; ++i) refs.push_back(k.q(i).ref);
  refs.push_back(k.p(0).ref);
  refs.push_back(k.number(-3, 2).ref);
  refs.push_back(k.number(2).ref);
  for (std::uint64_t step = 0; step < 40; ++step) {
    const std::uint64_t r = program::hash_mix(seed, step);
    const symbolic::Ref a = refs[(r >> 8) % refs.size()], b = refs[(r >> 24) % refs.size()];
    switch (r % 11) {
      case 0:
      case 1: refs.push_back(dag.add(a, b)); break;
      case 2:
      case 3: refs.push_back(dag.sub(a, b)); break;
      case 4:
      case 5:
      case 6: refs.push_back(dag.mul(a, b)); break;
      case 7: refs.push_back(dag.div(a, dag.add(dag.one(), dag.power(b, 2)))); break;
      case 8: refs.push_back(dag.call(Op::sin, a)); break;
      case 9: refs.push_back(dag.call(Op::cos, a)); break;
      default: refs.push_back(dag.call(Op::sqrt, dag.add(dag.one(), dag.power(a, 2)))); break;
    }
  }
  return refs.back();
}

}  // namespace

TEST_CASE("optimiser: the value of every function stays the same to 45 digits") {
  for (const auto& [name, system] : systems()) {
    const std::string label(name);
    INFO(label);
    program::AbiFunctions functions(system, {});
    for (const bool optimise : {false, true}) {
      const auto built = build(system, {"jac", "mass", "constraints", "reactions"}, optimise, true);
      std::vector<std::string> outputs;
      for (const auto& output : system.outputs) outputs.push_back(output.name);
      std::vector<program::FunctionExpressions> wanted = {functions.rhs(), functions.jac(), functions.mass(),
                                                          functions.constraints(), functions.reactions()};
      if (!outputs.empty()) wanted.push_back(functions.outputs(outputs));
      REQUIRE(built.functions.size() == wanted.size() + (built.prepared_count() > 0 ? 2 : 0));
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto values = program::interpret(built.functions[i], arguments_at<cln::cl_R>(system, 3), 60);
        for (std::size_t r = 0; r < wanted[i].results.size(); ++r) {
          const auto expected = expressions_at(*system.dag, wanted[i].results[r].entries, 3);
          CHECK(difference(expected, values.results[r]) < tolerances::same_value);
        }
      }
    }
  }
}

TEST_CASE("optimiser: the value of random expressions stays the same to 45 digits") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    SystemBuilder k;
    program::FunctionExpressions wanted{
        "outputs", {{"y", {random_expression(k, seed), random_expression(k, seed + 1000)}}}, {}, {}};
    system::EquationSystem system;
    system.free = {0, 1, 2};
    const auto raw = program::from_dag(*k.dag, wanted, system.free);
    const auto best = program::optimise({program::flatten(raw, false), program::flatten(program::expand(raw), false)});
    const auto function = program::schedule(best, "outputs", {{"y", 2}});
    const auto expected = expressions_at(*k.dag, wanted.results[0].entries, seed);
    const auto got = program::interpret(function, arguments_at<cln::cl_R>(system, seed), 60);
    CHECK(difference(expected, got.results[0]) < tolerances::same_value);
    CHECK(program::count_operations(best).cost() <= program::count_operations(program::flatten(raw, false)).cost());
  }
}

TEST_CASE("optimiser: the operation count is that of the code") {
  for (const auto& [name, system] : systems()) {
    const std::string label(name);
    INFO(label);
    program::AbiFunctions functions(system, {});
    const auto wanted = functions.rhs();
    const auto graph = program::flatten(program::from_dag(*system.dag, wanted, system.free), false);
    const auto counted = program::count_operations(graph);
    const auto written = program::schedule(graph, "rhs", {{"dx", wanted.results[0].entries.size()}}).operations;
    CHECK(counted.add == written.add);
    CHECK(counted.mul == written.mul);
    CHECK(counted.div == written.div);
    CHECK(counted.sqrt == written.sqrt);
    CHECK(counted.trig == written.trig);
    CHECK(counted.other == written.other);
  }
}

TEST_CASE("optimiser: operation counts do not increase") {
  const auto flops = [](const system::EquationSystem& s) { return build(s).functions[0].operations.flops(); };
  CHECK(flops(pendulum()) == 1);          // -(g/l) sin theta
  CHECK(flops(double_pendulum()) <= 24);  // and three divisions; limit 40
  CHECK(flops(cart_pendulum()) <= 16);
  CHECK(flops(spherical_pendulum()) <= 32);
  CHECK(flops(chain(6)) <= 310);  // 315 by the recursive formulation; limit 460
}

TEST_CASE("optimiser: factors cancel symbolically") {
  const auto built = build(pendulum());
  const auto& function = built.functions[0];
  for (const auto& instruction : function.code) {
    for (const auto& operand : instruction.operands) {
      CHECK_FALSE((operand.slot == program::Slot::parameter && operand.index == 0));  // the mass
    }
  }
}

TEST_CASE("optimiser: sin^2 + cos^2 is 1, also inside shared products") {
  SystemBuilder k;
  const Scalar l = k.p(0), c = k.cos(k.q(0)), s = k.sin(k.q(0));
  const Scalar x = l * c, y = l * s;
  program::FunctionExpressions wanted{
      "outputs", {{"y", {(x * x + y * y).ref, x.ref, y.ref, (l - l * c * c).ref}}}, {}, {}};
  const auto best = program::optimise({program::flatten(program::from_dag(*k.dag, wanted, {0}), false)});
  const auto operations = program::count_operations(best);
  CHECK(operations.add == 0);
  CHECK(operations.mul <= 4);  // l l, l c, l s, (l s) s
}

TEST_CASE("optimiser: a divisor that is used twice costs one division") {
  SystemBuilder k;
  const Scalar d = k.q(0) + k.p(0);
  program::FunctionExpressions wanted{"outputs", {{"y", {(k.q(1) / d).ref, (k.q(2) / d).ref}}}, {}, {}};
  const auto best = program::optimise({program::flatten(program::from_dag(*k.dag, wanted, {0, 1, 2}), false)});
  CHECK(program::count_operations(best).div == 1);
}

TEST_CASE("optimiser: huge powers and divisions by zero neither hang nor overflow") {
  SystemBuilder k;
  symbolic::Dag& dag = *k.dag;
  const symbolic::Ref huge = dag.power(k.number(9).ref, 100000);
  const symbolic::Ref nested = dag.power(dag.add(dag.power(k.q(0).ref, 999999), dag.one()), 999999);
  const symbolic::Ref by_zero =
      dag.div(k.q(0).ref, dag.sub(dag.mul(k.q(1).ref, k.q(0).ref), dag.mul(k.q(0).ref, k.q(1).ref)));
  program::FunctionExpressions wanted{"outputs", {{"y", {huge, nested, by_zero}}}, {}, {}};
  const auto best = program::optimise({program::flatten(program::from_dag(dag, wanted, {0, 1}), false)});
  const auto function = program::schedule(best, "outputs", {{"y", 3}});
  program::Arguments<double> arguments{0, {0.5, 0.5, 0, 0}, {}, {}};
  const auto y = program::interpret(function, arguments).results[0];
  CHECK(std::isinf(y[0]));
  CHECK(y[1] == 1);
  CHECK_FALSE(std::isfinite(y[2]));
}

TEST_CASE("optimiser: the same system gives the same program, independent of earlier work") {
  const auto text = [](const program::Function& f) {
    std::string result;
    for (const auto& instruction : f.code) {
      result += fmt::format("{} {}", static_cast<int>(instruction.op), instruction.name);
      for (const auto& o : instruction.operands) {
        result += fmt::format(" {}:{}{}", static_cast<int>(o.slot), o.index, o.negated ? "-" : "+");
      }
      result += "\n";
    }
    return result;
  };
  const std::string first = text(build(chain(4)).functions[0]);
  std::vector<std::unique_ptr<int[]>> burnt;
  for (std::size_t i = 1; i < 200; ++i) burnt.push_back(std::make_unique<int[]>(i * 7));
  CHECK(first == text(build(chain(4)).functions[0]));
}

TEST_CASE("optimiser: a chain of twenty links takes seconds at most") {
  const auto begin = std::chrono::steady_clock::now();
  const auto built = build(chain(20));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  CHECK(built.functions[0].operations.flops() <= 4750);
  CHECK(seconds < tolerances::chain_seconds);
}

TEST_CASE("optimiser: squares of differences below a fraction are not multiplied out") {
  // 1/(1 + ((x - 1)/w)^2) is 0.8 at x = 1 + w/2, where x^2 - 2 x + 1 has no correct digit; the same for a rate.
  SystemBuilder k;
  constexpr double width = 1e-7;
  const Scalar w = k.p(0), one = k.number(1);
  for (std::uint8_t order = 0; order < 2; ++order) {
    const Scalar part = (k.q(0, order) - one) / w;
    const Scalar kinetic = k.number(1, 2) * k.q(0, 1) * k.q(0, 1);
    const auto built = build(lagrange(k, 1, kinetic, k.number(0), {one / (w * (one + part * part))}));
    program::Arguments<double> at;
    at.x = {0, 0};
    at.x[order] = 1 + width / 2;
    at.p = {width};
    CHECK(program::interpret(built.functions[0], at).results[0][1] * width == doctest::Approx(0.8).epsilon(1e-7));
  }
}
