// SPDX-License-Identifier: GPL-3.0-or-later
// Dag -> GiNaC -> sum -> Dag keeps the value of every function, and derivatives agree with the Dag's own.
#include <doctest/doctest.h>

#include "reading/by_name.hpp"
#include "reading/ginac_bridge.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using namespace eomgen::test;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

namespace {

// One ulp-sized difference of some 20 operations.
constexpr double rounding = 1e-12;

double value(const symbolic::Dag& dag, Ref r) {
  return symbolic::evaluate(dag, {r}, [](const Symbol& s) {
    return 0.31 + 0.17 * s.index + 0.11 * s.order + (s.kind == SymbolKind::parameter ? 0.05 : 0.0);
  })[0];
}

struct Nodes {
  System system{model::read_model(shipped("P7_moving_sphere"))};
  symbolic::Dag& dag = *system.mechanics.dag;
  Ref x = system.mechanics.q[1], y = system.mechanics.qdot[2], p = dag.symbol({SymbolKind::parameter, 0, 0});
};

std::vector<Ref> every_operation(Nodes& n) {
  symbolic::Dag& dag = n.dag;
  std::vector<Ref> roots{dag.add(n.x, n.p),
                         dag.sub(n.p, n.y),
                         dag.div(n.x, dag.add(n.p, n.y)),
                         dag.power(dag.add(n.x, n.p), 3),
                         dag.power(dag.sub(n.x, n.p), -2),
                         dag.pow(n.p, n.x),
                         dag.pi(),
                         dag.constant(symbolic::Rational(7) / 3)};
  for (const Op op : {Op::sqrt, Op::sin, Op::cos, Op::tan, Op::asin, Op::acos, Op::atan, Op::sinh, Op::cosh, Op::tanh,
                      Op::exp, Op::log, Op::abs, Op::sign}) {
    roots.push_back(dag.call(op, dag.mul(n.x, n.p)));
    roots.push_back(dag.call(op, dag.add(dag.mul(n.x, n.x), dag.mul(n.p, n.p))));
  }
  for (const Op op : {Op::atan2, Op::min, Op::max}) roots.push_back(dag.call(op, dag.sub(n.x, n.p), dag.mul(n.x, n.y)));
  roots.push_back(dag.select(n.x, n.p, dag.mul(n.x, n.y), dag.call(Op::sin, n.x)));
  roots.push_back(dag.select(n.p, n.x, dag.mul(n.x, n.y), dag.call(Op::sin, n.x)));
  return roots;
}

}  // namespace

TEST_CASE("bridge: every operation keeps its value in a round trip") {
  Nodes n;
  reading::GinacBridge bridge(n.system.mechanics);
  for (const Ref r : every_operation(n)) {
    const Ref back = reading::to_dag(n.dag, bridge.sum(r));
    CAPTURE(static_cast<int>(n.dag[r].op));
    CHECK(value(n.dag, back) == doctest::Approx(value(n.dag, r)).epsilon(rounding));
  }
}

TEST_CASE("bridge: GiNaC's derivatives agree with the Dag's") {
  Nodes n;
  reading::GinacBridge bridge(n.system.mechanics);
  const Symbol x = n.dag.symbol_of(n.x);
  symbolic::Derivation by_x = symbolic::partial_derivative(n.dag, x);
  for (const Ref r : every_operation(n)) {
    const Ref slope = reading::to_dag(n.dag, bridge.derivative(bridge.sum(r), x));
    CAPTURE(static_cast<int>(n.dag[r].op));
    CHECK(value(n.dag, slope) == doctest::Approx(value(n.dag, by_x(r))).epsilon(rounding));
  }
}

TEST_CASE("bridge: the same expression gives the same sum in any order of conversion") {
  Nodes n;
  reading::GinacBridge one(n.system.mechanics), two(n.system.mechanics);
  const std::vector<Ref> roots = every_operation(n);
  for (auto r = roots.rbegin(); r != roots.rend(); ++r) (void)one.sum(*r);  // other serial numbers in other order
  for (const Ref r : roots) CHECK(one.sum(r) == two.sum(r));
}
