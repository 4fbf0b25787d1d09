// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/series.hpp"

#include <doctest/doctest.h>

#include "symbolic/evaluate.hpp"

using namespace eomgen::symbolic;

namespace {

constexpr int series_digits = 60;
const Symbol first_symbol{SymbolKind::coordinate, 0, 0}, y_symbol{SymbolKind::coordinate, 1, 0};

// x(s) = 0.4 + 0.3 s - 0.1 s^2, y(s) = 0.7 - 0.2 s
cln::cl_R curve(const Symbol& symbol, std::size_t k) {
  const Rational x[] = {Rational(2) / 5, Rational(3) / 10, Rational(-1) / 10},
                 y[] = {Rational(7) / 10, Rational(-1) / 5};
  if (symbol == first_symbol) return k < 3 ? cln::cl_R(x[k]) : cln::cl_R(0);
  return k < 2 ? cln::cl_R(y[k]) : cln::cl_R(0);
}

}  // namespace

TEST_CASE("series: the power series of every function sums to its value along the curve") {
  Dag dag;
  const Ref x = dag.symbol(first_symbol), y = dag.symbol(y_symbol), two = dag.integer(2);
  std::vector<Ref> roots;
  for (const Op op : {Op::sqrt, Op::sin, Op::cos, Op::tan, Op::asin, Op::acos, Op::atan, Op::sinh, Op::cosh, Op::tanh,
                      Op::exp, Op::log, Op::abs, Op::sign}) {
    roots.push_back(dag.call(op, x));
    roots.push_back(dag.mul(y, dag.call(op, dag.mul(x, y))));
  }
  for (const Op op : {Op::atan2, Op::min, Op::max}) roots.push_back(dag.call(op, x, y));
  roots.push_back(dag.pow(x, dag.constant(Rational(7) / 3)));
  roots.push_back(dag.pow(x, y));
  roots.push_back(dag.power(dag.sub(x, dag.constant(Rational(2) / 5)), 5));  // 0 at the start
  roots.push_back(dag.power(dag.add(x, two), -5));
  roots.push_back(dag.div(dag.call(Op::sin, x), dag.add(two, y)));
  roots.push_back(dag.select(x, y, dag.mul(x, y), dag.pi()));
  PowerSeries series(dag, roots, series_digits);
  constexpr std::size_t orders = 30;
  for (std::size_t k = 0; k < orders; ++k) series.extend(curve);
  const cln::cl_R s = cln::cl_float(cln::cl_R(Rational(1) / 50), cln::float_format(series_digits));
  const auto at = [&](const Symbol& symbol) -> cln::cl_R {
    return curve(symbol, 0) + s * (curve(symbol, 1) + s * curve(symbol, 2));
  };
  const std::vector<cln::cl_R> exact = evaluate(dag, roots, at, series_digits);
  for (std::size_t r = 0; r < roots.size(); ++r) {
    cln::cl_R sum = 0;
    for (std::size_t k = orders; k-- > 0;) sum = sum * s + series[r][k];
    INFO("root ", r);
    CHECK(cln::abs(sum - exact[r]) <
          cln::cl_R(cln::expt(Rational(1) / 10, 30)));  // s^30 over the radius of convergence, 1/2 and more
  }
}
