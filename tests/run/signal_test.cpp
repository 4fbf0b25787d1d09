// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/signal.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace eomgen;
using symbolic::Op;

TEST_CASE("signal: an expression of t and parameters has the value of its formula") {
  symbolic::Dag dag;
  const symbolic::Ref t = dag.symbol({symbolic::SymbolKind::time, 0, 0}),
                      a = dag.symbol({symbolic::SymbolKind::parameter, 1, 0});
  const symbolic::Ref u = dag.add(dag.mul(a, dag.call(Op::sin, dag.mul(dag.pi(), t))), dag.power(t, 3));
  const run::Signal signal(dag, u, {7, 2.5});
  CHECK(signal(0.3, 0.3) == doctest::Approx(2.5 * std::sin(std::acos(-1.0) * 0.3) + 0.027).epsilon(1e-15));
  CHECK(signal.knots().empty());
}

TEST_CASE("signal: a table keeps its value up to the next time, and at a jump the side selects the value") {
  const run::Signal signal({0, 1, 2}, {3, 5, 8}, false);
  CHECK_FALSE(signal.is_varying());
  CHECK(signal(-1, -1) == 3);
  CHECK(signal(0.5, 0.5) == 3);
  CHECK(signal(1, 0.5) == 3);
  CHECK(signal(1, 1.5) == 5);
  CHECK(signal(9, 9) == 8);
}

TEST_CASE("signal: a linear table runs along straight lines and is constant outside") {
  const run::Signal signal({0, 1, 2}, {3, 5, 8}, true);
  CHECK(signal.is_varying());
  CHECK(signal(-1, -1) == 3);
  CHECK(signal(0.5, 0.5) == 4);
  CHECK(signal(1, 0.5) == 5);
  CHECK(signal(1.5, 1.5) == 6.5);
  CHECK(signal(9, 9) == 8);
}
