// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/polynomial.hpp"

#include <doctest/doctest.h>

#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen::symbolic;

namespace {

struct Symbols {
  Dag dag;
  Ref q(std::uint32_t i) { return dag.symbol({SymbolKind::coordinate, i, 0}); }
  Scalar s(Ref r) { return {&dag, r}; }
  Scalar sine(std::uint32_t i) { return s(dag.call(Op::sin, q(i))); }
  Scalar cosine(std::uint32_t i) { return s(dag.call(Op::cos, q(i))); }
};

cln::cl_R value(const Dag& dag, Ref f) {
  return evaluate(
      dag, {f}, [](const Symbol& x) -> cln::cl_R { return cln::cl_R(Rational(static_cast<long>(x.index) + 3) / 7); },
      50)[0];
}

}  // namespace

TEST_CASE("expansion: sin^2 + cos^2 becomes 1, alone and inside products") {
  Symbols x;
  Expander expand(x.dag);
  const Scalar s = x.sine(0), c = x.cosine(0), a = x.s(x.q(1));
  CHECK(expand((s * s + c * c).ref) == x.dag.one());
  CHECK(expand((a * s * s + a * c * c).ref) == a.ref);
  CHECK(expand((s * s * s * s + s * s * c * c).ref) == x.dag.power(s.ref, 2));
}

TEST_CASE("expansion: the velocity square in spherical coordinates has three terms") {
  Symbols x;
  Dag& dag = x.dag;
  const Scalar R = x.s(x.q(0)), sp = x.sine(1), cp = x.cosine(1), st = x.sine(2), ct = x.cosine(2);
  Derivation ddt = total_time_derivative(dag, 3, 0);
  Ref square = dag.zero();
  for (const Scalar component : {R * sp * ct, R * sp * st, R * cp})
    square = dag.add(square, dag.power(ddt(component.ref), 2));
  const auto rate = [&](std::uint32_t i) { return x.s(dag.symbol({SymbolKind::coordinate, i, 1})); };
  const Scalar expected = rate(0) * rate(0) + R * R * rate(1) * rate(1) + R * R * sp * sp * rate(2) * rate(2);
  Expander expand(dag);
  const auto result = expand(square);
  REQUIRE(result.has_value());
  CHECK(expand(dag.sub(*result, expected.ref)) == dag.zero());
  CHECK(dag.reachable({*result}).size() <= dag.reachable({expected.ref}).size() + 4);
}

TEST_CASE("expansion: values are preserved, with quotients, roots and powers") {
  Symbols x;
  Dag& dag = x.dag;
  const Scalar a = x.s(x.q(0)), b = x.s(x.q(1)), s = x.sine(2);
  const Scalar root = x.s(dag.call(Op::sqrt, (a * a + b * b).ref));
  for (const Scalar f : {(a + b) * (a - b) / (a * b), (a + s) / (b - s) + s / (b - s), root * root * (a - s),
                         x.s(dag.power((a - b).ref, 3)) / root, x.s(dag.power((a + b).ref, 20)) * s}) {
    Expander expand(dag);
    const auto result = expand(f.ref);
    REQUIRE(result.has_value());
    const cln::cl_R difference = cln::abs(value(dag, *result) - value(dag, f.ref));
    CHECK(difference < cln::abs(value(dag, f.ref)) * cln::cl_R(cln::expt(Rational(1) / 10, 40)));
  }
}

TEST_CASE("expansion: expressions beyond the budget are rejected, not attempted") {
  Symbols x;
  Ref sum = x.dag.one();
  for (std::uint32_t i = 0; i < 12; ++i) sum = x.dag.add(sum, x.q(i));
  Expander expand(x.dag, 100);
  CHECK_FALSE(expand(x.dag.power(sum, 8)).has_value());
}
