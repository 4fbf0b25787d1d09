// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/vectors.hpp"

#include <doctest/doctest.h>

#include <set>

#include "symbolic/polynomial.hpp"
#include "symbolic/sample.hpp"

using namespace eomgen::symbolic;

namespace {
Ref coordinate_of(Dag& dag, std::uint32_t i) { return dag.symbol({SymbolKind::coordinate, i, 0}); }
}  // namespace

TEST_CASE("vectors: a cross product is normal to both factors, and its square is Lagrange's identity") {
  Dag dag;
  const Vec3 a{coordinate_of(dag, 0), coordinate_of(dag, 1), coordinate_of(dag, 2)},
      b{coordinate_of(dag, 3), coordinate_of(dag, 4), coordinate_of(dag, 5)};
  const Vec3 c = cross(dag, a, b);
  CHECK(dag.is_zero(expand_or_keep(dag, dot(dag, a, c))));
  CHECK(dag.is_zero(expand_or_keep(dag, dot(dag, b, c))));
  const Ref squares = dag.sub(dag.mul(dot(dag, a, a), dot(dag, b, b)), dag.power(dot(dag, a, b), 2));
  CHECK_FALSE(dag.is_zero(expand_or_keep(dag, squares)));
  CHECK(dag.is_zero(expand_or_keep(dag, dag.sub(dot(dag, c, c), squares))));
  CHECK(is_zero(dag, subtract(dag, add(dag, a, b), add(dag, b, a))));
  CHECK(is_zero(dag, cross(dag, a, scale(dag, dag.integer(3), a))));
  CHECK_FALSE(is_zero(dag, c));
}

TEST_CASE("vectors: products with a matrix and its transpose") {
  Dag dag;
  const Ref x = coordinate_of(dag, 0), y = coordinate_of(dag, 1);
  const std::vector<Rational> C{1, 2, 0, Rational(-1) / 3};  // rows (1, 2) and (0, -1/3)
  CHECK(multiply(dag, C, {x, y}) ==
        std::vector<Ref>{dag.add(x, dag.mul(dag.integer(2), y)), dag.mul(dag.constant(C[3]), y)});
  CHECK(multiply_transposed(dag, C, {x, y}) ==
        std::vector<Ref>{x, dag.add(dag.mul(dag.integer(2), x), dag.mul(dag.constant(C[3]), y))});
}

TEST_CASE("sample: values differ by symbol, order, kind and point, and are in the documented range") {
  std::set<double> seen;
  for (const SymbolKind kind : {SymbolKind::coordinate, SymbolKind::parameter, SymbolKind::time}) {
    for (std::uint32_t index = 0; index < 5; ++index) {
      for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
        for (std::uint64_t point = 0; point < 4; ++point) {
          const Symbol symbol{kind, index, order};
          const double value = sample_double(symbol, point);
          CHECK(value >= 0.2);
          CHECK(value < 1.2);
          // One rounding of the quotient, one of the sum.
          CHECK(value == doctest::Approx(cln::double_approx(sample(symbol, point))).epsilon(1e-15));
          CHECK(seen.insert(value).second);
        }
      }
    }
  }
}

TEST_CASE("expansion: beyond the budget an expression is unchanged, and the shorter form is chosen on request") {
  Dag dag;
  const Ref x = coordinate_of(dag, 0), y = coordinate_of(dag, 1);
  const Ref power = dag.power(dag.add(x, y), 6);  // 7 terms
  CHECK(expand_or_keep(dag, power, 3) == power);
  CHECK_FALSE(expand_or_keep(dag, power, 10) == power);
  CHECK(expand_if_shorter(dag, power, 10) == power);
  CHECK(expand_if_shorter(dag, dag.sub(dag.mul(x, dag.add(y, dag.one())), dag.mul(x, y)), 40) == x);
}

TEST_CASE("dag: kinks are found anywhere in an expression") {
  Dag dag;
  const Ref x = coordinate_of(dag, 0), y = coordinate_of(dag, 1), one = dag.one();
  for (const Ref kink : {dag.call(Op::abs, x), dag.call(Op::sign, x), dag.call(Op::min, x, y), dag.call(Op::max, x, y),
                         dag.select(x, y, one, y)}) {
    CHECK(dag.has_kinks({y, dag.call(Op::sin, dag.add(kink, y))}));
  }
  CHECK_FALSE(dag.has_kinks({dag.call(Op::sqrt, x), dag.div(one, y), dag.call(Op::atan2, x, y)}));
}
