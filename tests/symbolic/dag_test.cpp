// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/dag.hpp"

#include <doctest/doctest.h>

#include "symbolic/evaluate.hpp"

using namespace eomgen::symbolic;

namespace {
Ref coordinate(Dag& dag, std::uint32_t i) { return dag.symbol({SymbolKind::coordinate, i, 0}); }
}  // namespace

TEST_CASE("dag: equal expressions are one node, regardless of the order of operands") {
  Dag dag;
  const Ref x = coordinate(dag, 0), y = coordinate(dag, 1);
  CHECK(dag.add(x, y) == dag.add(y, x));
  CHECK(dag.mul(x, y) == dag.mul(y, x));
  CHECK(dag.sub(x, y) == dag.neg(dag.sub(y, x)));
  CHECK(dag.mul(dag.neg(x), y) == dag.neg(dag.mul(x, y)));
  CHECK(dag.mul(dag.sub(x, y), dag.sub(y, x)) == dag.neg(dag.power(dag.sub(x, y), 2)));
  CHECK(dag.call(Op::sin, dag.neg(x)) == dag.neg(dag.call(Op::sin, x)));
  CHECK(dag.call(Op::cos, dag.sub(x, y)) == dag.call(Op::cos, dag.sub(y, x)));
  CHECK(dag.mul(dag.mul(dag.integer(2), x), dag.integer(3)) == dag.mul(dag.integer(6), x));
  CHECK(dag.mul(dag.power(x, 2), dag.power(x, 3)) == dag.power(x, 5));
  CHECK(dag.add(x, x) == dag.mul(dag.integer(2), x));
}

TEST_CASE("dag: zeros and ones are eliminated, exact numbers are folded exactly") {
  Dag dag;
  const Ref x = coordinate(dag, 0);
  CHECK(dag.is_zero(dag.sub(x, x)));
  CHECK(dag.mul(dag.zero(), x) == dag.zero());
  CHECK(dag.div(x, x) == dag.one());
  CHECK(dag.power(x, 0) == dag.one());
  const Ref third = dag.div(dag.one(), dag.integer(3));
  CHECK(dag.mul(third, dag.integer(3)) == dag.one());
  CHECK(dag.call(Op::sqrt, dag.constant(Rational(9) / 4)) == dag.constant(Rational(3) / 2));
  CHECK(dag[dag.call(Op::sqrt, dag.integer(2))].op == Op::sqrt);
  CHECK(dag.pow(x, dag.constant(Rational(1) / 2)) == dag.call(Op::sqrt, x));
  CHECK(dag.pow(x, dag.constant(Rational(3) / 2)) == dag.power(dag.call(Op::sqrt, x), 3));
}

TEST_CASE("dag: sines and cosines of multiples of pi are fractions, or those of angles between 0 and pi/2") {
  Dag dag;
  const auto turned = [&](Op function, const Rational& r) {
    return dag.call(function, dag.mul(dag.constant(r), dag.pi()));
  };
  CHECK(dag.is_zero(dag.call(Op::sin, dag.pi())));
  CHECK(dag.call(Op::cos, dag.pi()) == dag.integer(-1));
  CHECK(dag.is_zero(dag.call(Op::cos, dag.div(dag.pi(), dag.integer(2)))));
  CHECK(dag.call(Op::sin, dag.neg(dag.div(dag.pi(), dag.integer(2)))) == dag.integer(-1));
  for (long k = -48; k <= 48; ++k) {
    const Rational r = Rational(k) / 12;
    for (const Op function : {Op::sin, Op::cos}) {
      CAPTURE(k);
      const Ref found = turned(function, r);
      const cln::cl_R value = evaluate(
          dag, {found}, [](const Symbol&) -> cln::cl_R { return 0; }, 40)[0];
      const cln::cl_F angle = cln::cl_float(r, cln::float_format(60)) * cln::pi(cln::float_format(60));
      CHECK(cln::abs(value - (function == Op::sin ? cln::sin(angle) : cln::cos(angle))) < 1e-35);
      // Of 24 angles, fractions are the sines of 8 and the cosines of as many.
      const long from_axis = (function == Op::sin ? k : k + 6) % 12, steps = from_axis < 0 ? from_axis + 12 : from_axis;
      CHECK(dag.is_constant(found) == (steps == 0 || steps == 2 || steps == 6 || steps == 10));
    }
  }
  CHECK(turned(Op::sin, Rational(8) / 7) == dag.neg(turned(Op::sin, Rational(1) / 7)));
  CHECK(turned(Op::cos, Rational(-6) / 7) == dag.neg(turned(Op::cos, Rational(1) / 7)));
}

TEST_CASE("dag: huge powers of numbers stay symbolic") {
  Dag dag;
  const Ref huge = dag.power(dag.integer(9), 100000);
  CHECK(dag[huge].op == Op::power);
}

TEST_CASE("dag: the rules preserve the value of random expressions to 40 digits") {
  // A random expression is built twice: with the rules on the Dag, and directly in CLN numbers.
  std::uint64_t state = 7;
  const auto random = [&state](std::uint64_t n) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<std::size_t>((state >> 33) % n);
  };
  const auto format = cln::float_format(60);
  for (int trial = 0; trial < 50; ++trial) {
    Dag dag;
    std::vector<Ref> refs;
    std::vector<cln::cl_R> values, leaves;
    for (std::uint32_t i = 0; i < 4; ++i) {
      leaves.push_back(cln::cl_float(cln::cl_R(Rational(static_cast<long>(random(900)) + 100) / 1000), format));
      refs.push_back(coordinate(dag, i));
      values.push_back(leaves.back());
    }
    for (long k = -2; k <= 3; ++k) {
      refs.push_back(dag.integer(k));
      values.push_back(cln::cl_float(cln::cl_R(Rational(k)), format));
    }
    for (int step = 0; step < 40; ++step) {
      const std::size_t a = random(refs.size()), b = random(refs.size());
      if (cln::abs(values[a]) > 1000 || cln::abs(values[b]) > 1000) continue;
      switch (random(7)) {
        case 0:
          refs.push_back(dag.add(refs[a], refs[b]));
          values.push_back(values[a] + values[b]);
          break;
        case 1:
          refs.push_back(dag.sub(refs[a], refs[b]));
          values.push_back(values[a] - values[b]);
          break;
        case 2:
          refs.push_back(dag.mul(refs[a], refs[b]));
          values.push_back(values[a] * values[b]);
          break;
        case 3:
          if (cln::abs(values[b]) < cln::cl_R(Rational(1) / 100)) break;
          refs.push_back(dag.div(refs[a], refs[b]));
          values.push_back(values[a] / values[b]);
          break;
        case 4:
          refs.push_back(dag.neg(refs[a]));
          values.push_back(-values[a]);
          break;
        case 5:
          refs.push_back(dag.power(refs[a], 2));
          values.push_back(values[a] * values[a]);
          break;
        default:
          refs.push_back(dag.call(Op::sin, refs[a]));
          values.push_back(cln::sin(values[a]));
          break;
      }
    }
    const auto result = evaluate(
        dag, refs, [&](const Symbol& s) -> cln::cl_R { return leaves[s.index]; }, 60);
    for (std::size_t i = 0; i < refs.size(); ++i) {
      const cln::cl_R scale = cln::abs(values[i]) + 1;
      CHECK(cln::abs(result[i] - values[i]) / scale < cln::cl_R(cln::expt(Rational(1) / 10, 40)));
    }
  }
}

TEST_CASE("dag: roots of squares are simplified for positive expressions only") {
  Dag dag;
  const Ref x = coordinate(dag, 0), y = coordinate(dag, 1);
  const Ref square = dag.mul(dag.power(x, 2), dag.constant(Rational(9) / 4));
  CHECK(dag[dag.call(Op::sqrt, square)].op == Op::sqrt);
  dag.assume_positive({SymbolKind::coordinate, 0, 0});
  CHECK(dag.call(Op::sqrt, square) == dag.mul(dag.constant(Rational(3) / 2), x));
  CHECK(dag.call(Op::sqrt, dag.power(dag.add(x, dag.one()), 4)) == dag.power(dag.add(x, dag.one()), 2));
  CHECK(dag[dag.call(Op::sqrt, dag.mul(dag.power(x, 2), dag.power(y, 2)))].op == Op::sqrt);
}

TEST_CASE("dag: a value does not depend on the number of unrelated nodes") {
  Dag dag;
  const Ref x = coordinate(dag, 0), y = coordinate(dag, 1);
  const Ref early = dag.add(dag.call(Op::sin, x), dag.mul(y, dag.integer(3)));
  const auto lookup = [](const Symbol& s) { return s.index == 0 ? 0.5 : 0.25; };
  const double before = evaluate(dag, {early, x}, lookup)[0];
  for (long i = 4; i < 5000; ++i) dag.integer(i);
  const Ref late = dag.div(early, dag.integer(4999));
  const std::vector<double> after = evaluate(dag, {late, early, x}, lookup);
  CHECK(after[1] == before);
  CHECK(after[0] == before / 4999);
  CHECK(after[2] == 0.5);
}
