// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/tape.hpp"

#include <doctest/doctest.h>

#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

using namespace eomgen;
using linear::Precise;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

namespace {

const Symbol x{SymbolKind::coordinate, 0, 0}, y{SymbolKind::coordinate, 1, 0};

std::vector<Ref> expressions(symbolic::Dag& dag) {
  const Ref a = dag.symbol(x), b = dag.symbol(y), c = dag.div(a, dag.add(a, dag.integer(3)));
  std::vector<Ref> all{dag.sub(dag.mul(a, b), dag.power(b, 3)),
                       dag.div(a, b),
                       dag.pow(a, b),
                       dag.neg(dag.mul(dag.pi(), a)),
                       dag.call(Op::atan2, a, b),
                       dag.call(Op::min, a, b),
                       dag.call(Op::max, a, b),
                       dag.select(a, b, c, dag.mul(a, a))};
  for (const Op op : {Op::sqrt, Op::sin, Op::cos, Op::tan, Op::asin, Op::acos, Op::atan, Op::sinh, Op::cosh, Op::tanh,
                      Op::exp, Op::log, Op::abs, Op::sign}) {
    all.push_back(dag.call(op, dag.mul(c, b)));
  }
  return all;
}

}  // namespace

TEST_CASE("derivatives of every operation match symbolic differentiation, in 160 digits and in binary64") {
  symbolic::Dag dag;
  std::vector<Ref> roots = expressions(dag), slopes;
  for (const Ref r : roots) {
    for (const Symbol& s : {x, y}) slopes.push_back(symbolic::partial_derivative(dag, s)(r));
  }
  const linear::Tape tape(dag, roots, {x, y});
  for (std::uint64_t point = 1; point <= 3; ++point) {
    const auto precise = [point](const Symbol& s) -> Precise {
      return linear::number<Precise>(symbolic::sample(s, point));
    };
    const auto rough = [point](const Symbol& s) { return symbolic::sample_double(s, point); };
    const auto expected =
        symbolic::evaluate(dag, slopes, std::function<Precise(const Symbol&)>(precise), linear::working_digits);
    const auto values =
        symbolic::evaluate(dag, roots, std::function<Precise(const Symbol&)>(precise), linear::working_digits);
    const auto got = tape.at<Precise>(precise);
    const auto got_rough = tape.at<double>(rough);
    for (std::size_t i = 0; i < roots.size(); ++i) {
      CAPTURE(i);
      CHECK(cln::abs(got.value[i] - values[i]) < linear::tiny<Precise>(150));  // a few roundings of 160 digits
      for (std::size_t d = 0; d < 2; ++d) {
        CHECK(cln::abs(got.jacobian(i, d) - expected[2 * i + d]) < linear::tiny<Precise>(150));
        CHECK(got_rough.jacobian(i, d) == doctest::Approx(cln::double_approx(expected[2 * i + d])).epsilon(1e-13));
      }
    }
  }
}

TEST_CASE("the tape reports a missing value or derivative") {
  symbolic::Dag dag;
  const Ref a = dag.symbol(x), b = dag.symbol(y);
  const auto zero = [](const Symbol& s) { return s == x ? 0.0 : 1.0; };
  for (const Ref r : {dag.div(b, a), dag.call(Op::sqrt, dag.power(a, 2)), dag.call(Op::log, a), dag.call(Op::abs, a),
                      dag.call(Op::asin, b), dag.call(Op::max, a, dag.mul(a, b))}) {
    CHECK_THROWS_AS(linear::Tape(dag, {r}, {x, y}).at<double>(zero), std::domain_error);
  }
  // The root of 0 is 0 if it depends on no direction.
  CHECK(linear::Tape(dag, {dag.call(Op::sqrt, dag.power(a, 2))}, {y}).at<double>(zero).value[0] == 0);
}
