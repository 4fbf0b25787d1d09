// SPDX-License-Identifier: GPL-3.0-or-later
// Kinks: with the sides of the actual state the program is unchanged; with other sides the branch continues beyond its
// surface.
#include "program/kinks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"
#include "system/expressions.hpp"

using namespace eomgen;
using namespace test_systems;
using symbolic::Op;
using symbolic::Ref;
using symbolic::SymbolKind;

namespace {

/// One coordinate of unit mass under the force from `make`, whose arguments are x, v, t and a parameter.
template <class Make>
system::EquationSystem one_mass(Make make) {
  system::EquationSystem s;
  s.dag = std::make_shared<symbolic::Dag>();
  symbolic::Dag& dag = *s.dag;
  s.formulation = "test";
  s.free = {0};
  s.M = {dag.one()};
  const Ref x = dag.symbol({SymbolKind::coordinate, 0, 0}), v = dag.symbol({SymbolKind::coordinate, 0, 1});
  s.f = {make(dag, x, v, dag.symbol({SymbolKind::time, 0, 0}), dag.symbol({SymbolKind::parameter, 0, 0}))};
  return s;
}

// min(x, t) + |x^2 - v| + if(v < |x - 1/2|, x v, v^3) + max(p, 0) + sign(x - 1/2)
system::EquationSystem all_kinds() {
  return one_mass([](symbolic::Dag& dag, Ref x, Ref v, Ref t, Ref p) {
    const Ref inner = dag.sub(x, dag.constant(symbolic::Rational(1) / 2));
    Ref f = dag.add(dag.call(Op::min, x, t), dag.call(Op::abs, dag.sub(dag.power(x, 2), v)));
    f = dag.add(f, dag.select(v, dag.call(Op::abs, inner), dag.mul(x, v), dag.power(v, 3)));
    f = dag.add(f, dag.call(Op::max, p, dag.zero()));
    return dag.add(f, dag.call(Op::sign, inner));
  });
}

}  // namespace

TEST_CASE("kinks: five kinks have four surfaces; frozen on the actual side, the right-hand side is unchanged") {
  const auto system = all_kinds();
  const auto plain = build(system), held = build(system, {"events", "jac"});
  CHECK(plain.kinks.empty());
  REQUIRE(held.kinks.size() == 4);  // |x - 1/2| and sign(x - 1/2) share one; max(p, 0) never switches
  int negative = 0;
  for (std::uint64_t point = 1; point <= 20; ++point) {
    auto arguments = arguments_at<cln::cl_R>(system, point);
    const auto expected = program::interpret(plain.functions[0], arguments, 60).results[0];
    CHECK(difference(program::interpret(held.functions[0], arguments, 60).results[0], expected) <
          tolerances::same_value);
    const auto g = program::interpret(held.functions[1], arguments, 60).results[0];
    REQUIRE(g.size() == 4);
    for (const cln::cl_R& value : g) {
      arguments.side.push_back(cln::minusp(value) ? -1 : 1);
      negative += cln::minusp(value) ? 1 : 0;
    }
    CHECK(difference(program::interpret(held.functions[0], arguments, 60).results[0], expected) <
          tolerances::same_value);
  }
  CHECK(negative > 20);
  CHECK(negative < 60);  // of 80: there are points on both sides
}

TEST_CASE("kinks: a frozen branch continues beyond its surface, and so does its Jacobian") {
  const auto system = one_mass([](symbolic::Dag& dag, Ref x, Ref v, Ref, Ref) {
    return dag.mul(v, dag.call(Op::max, dag.zero(), x));  // g = -x: above its surface x < 0 and the force is 0
  });
  const auto held = build(system, {"events", "jac"});
  auto arguments = arguments_at<cln::cl_R>(system, 1);
  const cln::cl_R x = arguments.x[0], v = arguments.x[1];
  for (const int side : {-1, 1}) {
    arguments.side = {side};
    for (const int sign : {1, -1}) {
      arguments.x[0] = sign * x;
      const auto dx = program::interpret(held.functions[0], arguments, 60).results[0];
      const auto jac = program::interpret(held.functions[2], arguments, 60).results[0];
      const cln::cl_R force = side < 0 ? cln::cl_R(sign * x * v) : cln::cl_R(0);
      CHECK(difference({dx[1]}, {force}) < tolerances::same_value);
      CHECK(difference({jac[1], jac[3]}, {side < 0 ? v : cln::cl_R(0), side < 0 ? cln::cl_R(sign * x) : cln::cl_R(0)}) <
            tolerances::same_value);
    }
  }
}

TEST_CASE("kinks: x - c and c - x are one surface, however they are written") {
  const auto system = one_mass([](symbolic::Dag& dag, Ref x, Ref v, Ref, Ref) {
    const Ref half = dag.constant(symbolic::Rational(1) / 2);
    // |x - 1/2| + 3 sign(1/2 - x) + 5 max(x, 1/2) + v if(1/2 - (v + x) + v < 0, 1, 2)
    Ref f = dag.add(dag.call(Op::abs, dag.sub(x, half)), dag.mul(dag.integer(3), dag.call(Op::sign, dag.sub(half, x))));
    f = dag.add(f, dag.mul(dag.integer(5), dag.call(Op::max, x, half)));
    const Ref written = dag.add(dag.sub(half, dag.add(v, x)), v);
    return dag.add(f, dag.mul(v, dag.select(written, dag.zero(), dag.one(), dag.integer(2))));
  });
  const auto held = build(system, {"events"});
  REQUIRE(held.kinks.size() == 1);
  auto arguments = arguments_at<cln::cl_R>(system, 1);
  const cln::cl_R v = arguments.x[1], half = cln::cl_R(1) / 2;
  const auto g = [&] { return program::interpret(held.functions[1], arguments, 60).results[0][0]; };
  for (const int side : {-1, 1}) {
    for (const cln::cl_RA& x : {cln::cl_RA("1/5"), cln::cl_RA("9/10")}) {
      arguments.x[0] = x;
      arguments.side = {};
      const bool above = (g() > 0) == (x > half);  // whether the surface is positive above 1/2
      arguments.side = {above ? side : -side};
      const auto dx = program::interpret(held.functions[0], arguments, 60).results[0];
      const cln::cl_R force =
          side > 0 ? cln::cl_R(x - half - 3 + 5 * x + v) : cln::cl_R(half - x + 3 + 5 * half + 2 * v);
      CHECK(difference({dx[1]}, {force}) < tolerances::same_value);
    }
  }
}

TEST_CASE("kinks: any number of them is frozen, and follows the state otherwise") {
  const auto system = one_mass([](symbolic::Dag& dag, Ref x, Ref, Ref, Ref) {
    Ref sum = dag.zero();
    for (long k = 1; k <= 50; ++k)
      sum = dag.add(sum, dag.call(Op::abs, dag.sub(x, dag.constant(symbolic::Rational(k) / 10))));
    return sum;
  });
  const auto plain = build(system), held = build(system, {"events"});
  CHECK(held.kinks == std::vector<std::string>(50, "abs"));
  const auto arguments = arguments_at<cln::cl_R>(system, 3);
  CHECK(difference(program::interpret(held.functions[0], arguments, 60).results[0],
                   program::interpret(plain.functions[0], arguments, 60).results[0]) < tolerances::same_value);
}

TEST_CASE("kinks: those of a contact law are frozen, except the speed whose sign the contact monitors") {
  auto s = one_mass([](symbolic::Dag& dag, Ref x, Ref, Ref, Ref) {
    return dag.sub(dag.symbol({SymbolKind::friction, 0, 0}), x);
  });
  symbolic::Dag& dag = *s.dag;
  const Ref x = dag.symbol({SymbolKind::coordinate, 0, 0}), v = dag.symbol({SymbolKind::coordinate, 0, 1});
  const Ref speed = dag.call(Op::abs, v), rough = dag.call(Op::abs, dag.sub(x, dag.one()));
  system::Contact contact;
  contact.name = "floor";
  contact.normal = dag.one();
  contact.slip = {v};
  contact.slip_rate = {dag.symbol({SymbolKind::coordinate, 0, 2})};
  contact.static_coefficient = dag.add(dag.one(), rough);
  contact.dynamic_coefficient = dag.add(speed, rough);
  s.contacts = {contact};
  CHECK(program::has_kinks(s));
  const std::vector<program::Kink> kinks = program::freeze_kink_branches(s);
  REQUIRE(kinks.size() == 1);
  CHECK(dag.call(Op::abs, kinks[0].value) == rough);
  const auto uses_side = [&](Ref r) {
    const auto symbols = dag.symbols({r});
    return std::find(symbols.begin(), symbols.end(), symbolic::Symbol{SymbolKind::branch, 0, 0}) != symbols.end();
  };
  CHECK(uses_side(s.contacts[0].static_coefficient));
  CHECK(uses_side(s.contacts[0].dynamic_coefficient));
  s.contacts[0].static_coefficient = s.contacts[0].dynamic_coefficient = speed;
  CHECK_FALSE(program::has_kinks(s));
}

TEST_CASE("system: for_each_expression visits every expression once") {
  system::EquationSystem s;
  s.dag = std::make_shared<symbolic::Dag>();
  std::uint32_t count = 0;
  const auto next = [&] { return s.dag->symbol({SymbolKind::parameter, count++, 0}); };
  const auto some = [&] { return std::vector<Ref>{next(), next()}; };
  s.M = some(), s.f = some(), s.psi = some(), s.A = some(), s.b = some(), s.gamma = some();
  s.states = {{{SymbolKind::integral, 0, 0}, next()}};
  s.quasi = system::QuasiVelocityEquations{{}, some(), some()};
  s.solution = system::Solution{some(), some(), {{next(), next()}}};
  s.solution->forces = system::InternalForces{{}, some(), some(), some(), some()};
  system::Contact contact;
  contact.gram = some(), contact.slip = some(), contact.slip_rate = some();
  contact.normal = next(), contact.static_coefficient = next(), contact.dynamic_coefficient = next();
  contact.directions = {{next(), next(), next()}};
  contact.width = next(), contact.restitution = next();
  s.contacts = {contact};
  s.reactions = {{0, "r", next()}}, s.outputs = {{"o", next(), system::OutputKind::definition}},
  s.events = {{"e", next()}};
  s.energy = next(), s.kinetic = next(), s.potential = next(), s.power = next();
  std::set<Ref> seen;
  const system::EquationSystem& constant = s;
  system::for_each_expression(constant, [&](Ref r, system::ExpressionRole) { CHECK(seen.insert(r).second); });
  CHECK(seen.size() == count);
}
