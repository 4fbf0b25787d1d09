// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of functions along one variable, and the features that they detect: kinks in time, narrow pulses.
#include <doctest/doctest.h>

#include <cmath>
#include <eom/hybrid/time_analysis.hpp>

#include "run/expression_tables.hpp"
#include "run/time_functions.hpp"

using namespace eomgen;
using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;

namespace {

run::SymbolMeaning time_is_variable(const symbolic::Symbol&) { return run::SymbolMeaning::of_variable(0); }

/// A system whose force is a function of time.
eom::hybrid::TimeAnalysis clock_of(const std::function<Ref(Dag&, Ref)>& force, double t1 = 10) {
  system::EquationSystem system;
  system.dag = std::make_shared<Dag>();
  Dag& dag = *system.dag;
  system.kinetic = system.potential = system.energy = system.power = dag.zero();
  system.f = {force(dag, dag.symbol({symbolic::SymbolKind::time, 0, 0}))};
  return eom::hybrid::analyse_time_functions(run::time_functions(system, {}), {}, {}, 0, t1);
}

Ref number(Dag& dag, long numerator, long denominator = 1) {
  return dag.constant(symbolic::Rational(numerator) / denominator);
}

}  // namespace

TEST_CASE("ranges: values and derivatives of every operation lie between its bounds") {
  Dag dag;
  const Ref t = dag.symbol({symbolic::SymbolKind::time, 0, 0}), half = number(dag, 1, 2);
  std::vector<Ref> functions;
  for (const Op op : {Op::sin, Op::cos, Op::tan, Op::atan, Op::sinh, Op::cosh, Op::tanh, Op::exp, Op::abs})
    functions.push_back(dag.call(op, dag.mul(t, number(dag, 7, 3))));
  for (const Op op : {Op::sqrt, Op::log}) functions.push_back(dag.call(op, dag.add(dag.power(t, 2), half)));
  for (const Op op : {Op::asin, Op::acos}) functions.push_back(dag.call(op, dag.div(t, number(dag, 3))));
  functions.push_back(dag.call(Op::atan2, dag.call(Op::sin, t), dag.call(Op::cos, t)));
  functions.push_back(dag.call(Op::min, t, dag.power(t, 3)));
  functions.push_back(dag.call(Op::max, t, dag.power(t, 2)));
  functions.push_back(dag.select(t, half, dag.power(t, 3), dag.neg(t)));
  functions.push_back(dag.div(dag.sub(t, half), dag.add(dag.power(t, 4), half)));
  functions.push_back(dag.pow(dag.add(dag.power(t, 2), half), dag.mul(t, half)));
  std::optional<run::Table> table = run::make_table(dag, functions, time_is_variable);
  REQUIRE(table);
  const eom::expressions::Code code(std::move(*table), {});
  constexpr double rounding = 1e-9;
  for (const double from : {-2.9, -1.3, -0.2, 0.0, 0.31, 1.4}) {
    for (const double width : {1.4, 0.3, 0.01}) {
      const std::vector<eom::expressions::SlopedInterval> box{{{from, from + width}, {1, 1}}};
      for (std::size_t i = 0; i < functions.size(); ++i) {
        CAPTURE(i);
        CAPTURE(from);
        CAPTURE(width);
        const eom::expressions::SlopedInterval range = code.range(box, i);
        for (int k = 0; k <= 20; ++k) {
          const double at = from + width * k / 20, h = 1e-6 * width;
          const double v = code.value(std::vector<double>{at}, i);
          CHECK(v >= range.value.low - rounding * std::abs(v));
          CHECK(v <= range.value.high + rounding * std::abs(v));
          if (k == 20) continue;
          const double slope = (code.value(std::vector<double>{at + h}, i) - v) / h;
          CHECK(slope >= range.slope.low - 1e-3 * std::abs(slope) - 1e-3);
          CHECK(slope <= range.slope.high + 1e-3 * std::abs(slope) + 1e-3);
        }
      }
    }
  }
}

TEST_CASE("clock: kinks in time are found at any distance, each to the last digit and none twice") {
  const eom::hybrid::TimeAnalysis pulse = clock_of([](Dag& dag, Ref t) {  // if(|t - 5.123| < 1e-7, 1, 0), and |t - 2|
    const Ref inside = dag.select(dag.call(Op::abs, dag.sub(t, number(dag, 5123, 1000))), number(dag, 1, 10'000'000),
                                  dag.one(), dag.zero());
    return dag.add(inside, dag.call(Op::abs, dag.sub(t, number(dag, 2))));
  });
  REQUIRE(pulse.breakpoints.size() == 4);  // also the middle of the pulse, where |t - 5.123| has its kink
  const double expected[] = {2, 5.123 - 1e-7, 5.123, 5.123 + 1e-7};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(pulse.breakpoints[i].before - expected[i]) < 4e-15);
    CHECK(pulse.breakpoints[i].after > pulse.breakpoints[i].before);
    CHECK(pulse.breakpoints[i].after - pulse.breakpoints[i].before < 4e-15);
  }
  const eom::hybrid::TimeAnalysis periodic = clock_of([](Dag& dag, Ref t) {
    return dag.select(number(dag, 9999, 10000), dag.call(Op::sin, dag.mul(number(dag, 20), t)), dag.one(), dag.zero());
  });
  CHECK(periodic.breakpoints.size() == 64);  // 32 maxima in 200 rad
  CHECK(!periodic.unresolved_from);
  const eom::hybrid::TimeAnalysis grazing =
      clock_of([](Dag& dag, Ref t) { return dag.call(Op::abs, dag.power(dag.sub(t, number(dag, 3)), 2)); });
  CHECK(grazing.breakpoints.empty());
  CHECK(grazing.bounds.empty());
}

TEST_CASE("clock: steps are limited where a smooth function of time is narrow, and nowhere else") {
  for (const double w : {1e-1, 1e-3, 1e-6}) {
    CAPTURE(w);
    const eom::hybrid::TimeAnalysis gauss = clock_of([&](Dag& dag, Ref t) {
      const Ref width = number(dag, static_cast<long>(std::lround(w * 1e6)), 1'000'000);
      return dag.call(Op::exp, dag.neg(dag.power(dag.div(dag.sub(t, number(dag, 5123, 1000)), width), 2)));
    });
    REQUIRE(!gauss.bounds.empty());
    const auto at = [&](double t) {
      double bound = 0;
      for (const eom::StepBound& b : gauss.bounds) {
        if (b.t <= t) bound = b.step;
      }
      return bound;
    };
    CHECK(at(5.123) <= 8 * w);
    CHECK(at(5.123) >= 0.5 * w);
    CHECK(at(1) > 1);
    CHECK(gauss.bounds.size() < 200);
  }
  CHECK(clock_of([](Dag& dag, Ref t) { return dag.power(t, 3); }).bounds.empty());
}
