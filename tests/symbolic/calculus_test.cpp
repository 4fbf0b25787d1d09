// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/calculus.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "symbolic/adjoint.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen::symbolic;

namespace {

const Symbol x_symbol{SymbolKind::coordinate, 0, 0};

cln::cl_R value(const Dag& dag, Ref f, const cln::cl_R& x) {
  return evaluate(
      dag, {f}, [&](const Symbol&) -> cln::cl_R { return x; }, 120)[0];
}

/// An expression for every function, operation and branch.
std::vector<Ref> every_function(Dag& dag) {
  const Ref x = dag.symbol(x_symbol);
  const Ref two = dag.integer(2);
  std::vector<Ref> functions;
  for (const Op op : {Op::sqrt, Op::sin, Op::cos, Op::tan, Op::asin, Op::acos, Op::atan, Op::sinh, Op::cosh, Op::tanh,
                      Op::exp, Op::log, Op::abs, Op::sign}) {
    functions.push_back(dag.call(op, x));
    functions.push_back(dag.call(op, dag.power(x, 2)));
  }
  functions.push_back(dag.call(Op::atan2, x, dag.add(dag.one(), x)));
  functions.push_back(dag.call(Op::min, x, two));
  functions.push_back(dag.call(Op::max, x, two));
  functions.push_back(dag.pow(x, dag.constant(Rational(7) / 3)));
  functions.push_back(dag.pow(x, x));
  functions.push_back(dag.power(dag.add(x, two), -5));
  functions.push_back(dag.div(dag.call(Op::sin, x), dag.add(two, dag.call(Op::cos, x))));
  functions.push_back(dag.select(x, two, dag.power(x, 3), x));
  return functions;
}

}  // namespace

TEST_CASE("calculus: every function's derivative agrees with differences at 120 digits") {
  Dag dag;
  const std::vector<Ref> functions = every_function(dag);
  const cln::cl_R at = cln::cl_float(cln::cl_R(Rational(37) / 100), cln::float_format(120));
  const cln::cl_R step = cln::cl_float(cln::cl_R(cln::expt(Rational(1) / 10, 30)), cln::float_format(120));
  // Central differences: the error is h^2 f'''/6 = 1e-60 times a number below 1e5.
  const cln::cl_R tolerance = cln::cl_R(cln::expt(Rational(1) / 10, 50));
  Derivation derivative = partial_derivative(dag, x_symbol);
  for (const Ref f : functions) {
    const cln::cl_R difference = (value(dag, f, at + step) - value(dag, f, at - step)) / (2 * step);
    CHECK(cln::abs(value(dag, derivative(f), at) - difference) < tolerance);
  }
}

TEST_CASE("calculus: gradients by reverse accumulation are the derivatives of forward mode") {
  Dag dag;
  // f(x) and f(y + x/2) of every function, weighted by a symbol that is held.
  const Symbol y_symbol{SymbolKind::coordinate, 1, 0}, w_symbol{SymbolKind::coordinate, 2, 0};
  const Ref x = dag.symbol(x_symbol), y = dag.symbol(y_symbol), w = dag.symbol(w_symbol);
  Substitution shifted(dag, {{x_symbol, dag.add(y, dag.div(x, dag.integer(2)))}});
  const std::vector<Ref> functions = every_function(dag);
  const auto value = [](const Symbol& symbol) -> cln::cl_R { return Rational(31 + 6 * symbol.index) / 100; };
  const auto value_of = [&](Ref r) { return evaluate(dag, {r}, value, 60)[0]; };
  const cln::cl_R tolerance = cln::cl_R(cln::expt(Rational(1) / 10, 50));
  for (const Ref f : functions) {
    const Ref product = dag.mul(f, shifted(f));
    const std::vector<Ref> got = gradient(dag, {product, x}, {w, dag.one()}, {x_symbol, y_symbol, w_symbol});
    const cln::cl_R by_x = value_of(dag.mul(w, partial_derivative(dag, x_symbol)(product))) + 1;
    const cln::cl_R by_y = value_of(dag.mul(w, partial_derivative(dag, y_symbol)(product)));
    CHECK(cln::abs(value_of(got[0]) - by_x) < tolerance);
    CHECK(cln::abs(value_of(got[1]) - by_y) < tolerance);
    CHECK(dag.is_zero(got[2]));
  }
}

TEST_CASE("calculus: gradients have a value where the branch that is not taken has no derivative") {
  Dag dag;
  const Symbol y_symbol{SymbolKind::coordinate, 1, 0};
  const Ref x = dag.symbol(x_symbol), y = dag.symbol(y_symbol), zero = dag.zero(), one = dag.one();
  // y + 2 for x = 0, and otherwise y/sqrt(x^2), sin(y/sqrt(x^2)): the same branch twice, and one within another.
  const Ref root = dag.call(Op::sqrt, dag.power(x, 2)), far = dag.div(y, root);
  const Ref size = dag.call(Op::abs, x);
  const Ref f = dag.select(zero, size, far, dag.add(y, dag.integer(2)));
  const Ref g = dag.select(zero, size, dag.call(Op::sin, dag.select(y, one, far, dag.power(far, 2))), y);
  const std::vector<Ref> got = gradient(dag, {f, g}, {dag.integer(3), dag.integer(5)}, {x_symbol, y_symbol});
  const auto binary = [&](Ref r, double at_x, double at_y) {
    const std::function<double(const Symbol&)> value = [&](const Symbol& s) { return s == x_symbol ? at_x : at_y; };
    return evaluate(dag, {r}, value)[0];
  };
  CHECK(binary(got[0], 0, 0.3) == 0);
  CHECK(binary(got[1], 0, 0.3) == 8);
  CHECK(binary(got[1], 2, 0.3) == doctest::Approx(3 / 2.0 + 5 * std::cos(0.15) / 2).epsilon(1e-14));
}

TEST_CASE("calculus: Jacobians take 0 as the slope of a norm at 0, and no other slope changes") {
  Dag dag;
  const Symbol y_symbol{SymbolKind::coordinate, 1, 0};
  const Ref x = dag.symbol(x_symbol), y = dag.symbol(y_symbol);
  const Ref square = dag.add(dag.power(x, 2), dag.mul(dag.integer(3), dag.power(dag.mul(x, y), 2)));
  const auto at = [&](Ref r, double at_x) {
    const std::function<double(const Symbol&)> value = [&](const Symbol& s) { return s == x_symbol ? at_x : 0.5; };
    return evaluate(dag, {r}, value)[0];
  };
  for (const Ref norm : {dag.call(Op::sqrt, square), dag.pow(square, dag.constant(Rational(3) / 4))}) {
    const Ref drag = dag.mul(norm, x);
    const VanishingNorms norms = vanishing_norms(dag, {drag});
    CHECK(norms == VanishingNorms{norm});
    const Ref plain = partial_derivative(dag, x_symbol)(drag);
    const Ref forward = partial_derivative(dag, x_symbol, norms)(drag);
    const Ref reverse = gradient(dag, {drag}, {dag.one()}, {x_symbol}, norms)[0];
    CHECK(!std::isfinite(at(plain, 0)));
    CHECK(at(forward, 0) == 0);
    CHECK(at(reverse, 0) == 0);
    CHECK(at(forward, 0.3) == doctest::Approx(at(plain, 0.3)).epsilon(1e-14));
    CHECK(at(reverse, 0.3) == doctest::Approx(at(plain, 0.3)).epsilon(1e-14));
    const Ref twice = partial_derivative(dag, x_symbol, norms)(forward);
    CHECK(at(twice, 0) == 0);
    // What divides by the norm has no value where it is 0.
    for (const Ref divided : {dag.div(x, norm), dag.div(x, dag.mul(y, dag.power(norm, 3))),
                              dag.pow(square, dag.constant(Rational(-1) / 3)), dag.pow(square, y)})
      CHECK(vanishing_norms(dag, {drag, divided}).empty());
    const Ref multiplied = dag.pow(square, dag.constant(Rational(4) / 3));
    CHECK(vanishing_norms(dag, {drag, multiplied}) == VanishingNorms{norm});
  }
  const Ref softened = dag.add(square, dag.one());
  for (const Ref other :
       {dag.call(Op::sqrt, x), dag.call(Op::sqrt, dag.call(Op::abs, x)), dag.call(Op::sqrt, softened),
        dag.pow(square, dag.constant(Rational(1) / 4)), dag.call(Op::sqrt, dag.sub(dag.power(x, 2), y))})
    CHECK(vanishing_norms(dag, {other}).empty());
}

TEST_CASE("calculus: the total time derivative follows coordinates, functions of time and time itself") {
  Dag dag;
  const Ref q = dag.symbol({SymbolKind::coordinate, 0, 0}), v = dag.symbol({SymbolKind::coordinate, 0, 1});
  const Ref a = dag.symbol({SymbolKind::coordinate, 0, 2});
  const Ref d = dag.symbol({SymbolKind::function, 0, 0}), d1 = dag.symbol({SymbolKind::function, 0, 1});
  const Ref t = dag.symbol({SymbolKind::time, 0, 0});
  Derivation ddt = total_time_derivative(dag, 1, 1);
  CHECK(ddt(dag.mul(q, d)) == dag.add(dag.mul(v, d), dag.mul(q, d1)));
  CHECK(ddt(v) == a);
  CHECK(ddt(dag.power(t, 2)) == dag.mul(dag.integer(2), t));
  Derivation frozen = total_time_derivative(dag, 1, 1, true);
  CHECK(dag.is_zero(frozen(v)));
  CHECK(frozen(q) == v);
}

TEST_CASE("calculus: a nest of 60 shared levels is differentiated on the graph, not on the tree") {
  Dag dag;
  Ref f = dag.symbol(x_symbol);
  for (int i = 0; i < 60; ++i) f = dag.mul(dag.call(Op::sin, f), dag.add(f, dag.one()));
  const Ref derivative = partial_derivative(dag, x_symbol)(f);
  CHECK(dag.reachable({derivative}).size() < 2000);
}

TEST_CASE("calculus: substitution replaces symbols and folds expressions that become constant") {
  Dag dag;
  const Ref x = dag.symbol(x_symbol), t = dag.symbol({SymbolKind::time, 0, 0});
  Substitution at_zero(dag, {{x_symbol, dag.zero()}});
  CHECK(at_zero(dag.add(dag.call(Op::cos, x), t)) == dag.add(dag.one(), t));
  Substitution by_time(dag, {{x_symbol, dag.power(t, 2)}});
  CHECK(by_time(dag.mul(x, t)) == dag.power(t, 3));
}
