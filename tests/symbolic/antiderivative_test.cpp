// SPDX-License-Identifier: GPL-3.0-or-later
// Antiderivatives against numerical differences; and proofs of zero that succeed and that must fail.
#include "symbolic/antiderivative.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "symbolic/evaluate.hpp"
#include "symbolic/zero_proof.hpp"

using namespace eomgen::symbolic;

namespace {

struct Letters {
  Dag dag;
  Symbol x_symbol{SymbolKind::coordinate, 0, 0};
  Scalar x{&dag, dag.symbol(x_symbol)}, y{&dag, dag.symbol({SymbolKind::coordinate, 1, 0})},
      a{&dag, dag.symbol({SymbolKind::parameter, 0, 0})};
  Scalar number(long n) { return {&dag, dag.integer(n)}; }
  Scalar f(Op op, Scalar u) { return {&dag, dag.call(op, u.ref)}; }
  Scalar power(Scalar u, long n) { return {&dag, dag.power(u.ref, n)}; }

  double value(Ref r, double at) {
    return evaluate(dag, {r}, [&](const Symbol& s) {
      return s == x_symbol ? at : s.kind == SymbolKind::parameter ? 0.7 : 1.3;
    })[0];
  }
};

}  // namespace

TEST_CASE("antiderivatives: their numerical derivative is the integrand") {
  Letters l;
  const Scalar x = l.x, y = l.y, a = l.a;
  const Scalar s = l.f(Op::sin, a * x + y), c = l.f(Op::cos, a * x + y), e = l.f(Op::exp, l.number(-2) * x);
  const std::vector<Scalar> integrands{a * y,
                                       x,
                                       l.power(x, 3) * y,
                                       a / x,
                                       y / l.power(x, 2),
                                       s,
                                       l.power(s, 2),
                                       l.power(c, 3) * s,
                                       x * c,
                                       l.power(x, 2) * e,
                                       s * e,
                                       x * l.f(Op::exp, x * x),
                                       x / l.f(Op::sqrt, x * x + y * y),
                                       l.f(Op::tan, x),
                                       l.number(1) / (x * x + y * y),
                                       x / (x * x + l.number(1)),
                                       x / (x * x + y * y),
                                       (x - y) / (l.power(x - y, 2) + a),
                                       (l.number(2) * x + y) / (x * x + y * x + a),
                                       l.number(1) / l.power(l.f(Op::cos, x), 2),
                                       (x + y) * (x - y),
                                       l.f(Op::sinh, x) + l.f(Op::cosh, a * x)};
  for (const Scalar& integrand : integrands) {
    const std::optional<Ref> F = antiderivative(l.dag, integrand.ref, l.x_symbol);
    REQUIRE(F);
    constexpr double h = 1e-5;  // 1e-10 of truncation and of rounding
    for (const double at : {0.4, 0.9}) {
      const double slope = (l.value(*F, at + h) - l.value(*F, at - h)) / (2 * h);
      CHECK(slope == doctest::Approx(l.value(integrand.ref, at)).epsilon(1e-8));
    }
  }
  CHECK_FALSE(antiderivative(l.dag, l.f(Op::exp, x * x).ref, l.x_symbol));
  CHECK_FALSE(antiderivative(l.dag, (l.f(Op::sin, x) / x).ref, l.x_symbol));
}

TEST_CASE("antiderivatives: u'/u is integrated for negative u too, where log u is undefined") {
  Letters l;
  const Scalar x = l.x, integrand = x / (x * x - l.number(5));
  const std::optional<Ref> plain = antiderivative(l.dag, integrand.ref, l.x_symbol);
  const std::optional<Ref> any = antiderivative(l.dag, integrand.ref, l.x_symbol, LogarithmDomain::any_sign);
  REQUIRE(plain);
  REQUIRE(any);
  CHECK(std::isnan(l.value(*plain, 1)) != std::isnan(l.value(*plain, 3)));
  CHECK(std::isfinite(l.value(*any, 3)));
  CHECK(l.value(*any, 1) - l.value(*any, 0) == doctest::Approx(std::log(4.0 / 5) / 2).epsilon(1e-14));
}

TEST_CASE("dag: 0/0 is not folded to a number") {
  Letters l;
  const Ref quotient = l.dag.div(l.dag.zero(), l.dag.zero());
  CHECK_FALSE(l.dag.is_constant(quotient));
  CHECK(std::isnan(l.value(quotient, 1)));
}

TEST_CASE("zeros: identities of angles, exponentials and fractions are proven, nonzero expressions never are") {
  Letters l;
  const Scalar x = l.x, y = l.y, one = l.number(1), two = l.number(2);
  const auto sin = [&](Scalar u) { return l.f(Op::sin, u); };
  const auto cos = [&](Scalar u) { return l.f(Op::cos, u); };
  const auto root = [&](Scalar u) { return l.f(Op::sqrt, u); };
  const std::vector<Scalar> zeros{
      sin(x) * sin(x) + cos(x) * cos(x) - one,
      sin(x + y) - sin(x) * cos(y) - cos(x) * sin(y),
      cos(two * x) - one + two * sin(x) * sin(x),
      l.f(Op::tan, x) * cos(x) - sin(x),
      one / (x - y) - (x + y) / (x * x - y * y),
      l.power(l.f(Op::cosh, x), 2) - l.power(l.f(Op::sinh, x), 2) - one,
      l.f(Op::tanh, x) - l.f(Op::sinh, x) / l.f(Op::cosh, x),
      l.power(sin(x), 4) - l.power(one - l.power(cos(x), 2), 2),
      l.power(root(x * x + y), 3) - root(x * x + y) * (x * x + y),
      x / root(x * x + y) - x * root(x * x + y) / (x * x + y),
      one / (root(l.number(3)) * (root(l.number(3)) * (one + l.power(x / root(l.number(3)), 2)))) -
          one / (x * x + l.number(3)),
      l.power(root(one + root(x)) * y, 2) * (root(x) - one) - y * y * (x - one)};
  for (const Scalar& zero : zeros) CHECK(is_proven_zero(l.dag, zero.ref));
  const Scalar small{&l.dag, l.dag.constant(Rational(1) / cln::expt(Rational(10), 60))};
  for (const Scalar& zero : zeros) CHECK_FALSE(is_proven_zero(l.dag, (zero + small * x).ref));
  CHECK_FALSE(is_proven_zero(l.dag, sin(x).ref));
}
