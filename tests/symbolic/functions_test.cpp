// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical checks of each row of the function table: derivative, symmetry, value at 0.
#include "symbolic/functions.hpp"

#include <doctest/doctest.h>

#include <string>

#include "symbolic/arithmetic.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen::symbolic;
using cln::cl_R;

namespace {

constexpr int digits = 60;

cl_R ten_to_minus(int exponent) { return cl_R(cln::expt(Rational(1) / 10, exponent)); }

const ClnArithmetic precise{cln::float_format(digits)};

/// f(x) for a row with one argument.
cl_R value(const Function& f, const cl_R& x) { return precise.call(f.op, precise.round(x)); }

struct Numbers {
  static cl_R one() { return 1; }
  static cl_R two() { return 2; }
  static cl_R square(const cl_R& x) { return x * x; }
  static cl_R call(Op op, const cl_R& x) { return precise.call(op, precise.round(x)); }
};

}  // namespace

TEST_CASE("the derivative of every function of one argument is the limit of its difference quotients") {
  const cl_R h = ten_to_minus(20), x = Rational(3) / 7;
  for (const Function& f : function_table) {
    if (f.arity != 1 || f.op == Op::sign) continue;
    CAPTURE(f.name);
    REQUIRE(f.slope() != Slope::none);
    const auto [size, divides, falls] = slope_of(f, x, value(f, x), Numbers{});
    const cl_R slope = (falls ? cl_R(-1) : cl_R(1)) * (divides ? cl_R(1) / size : size);
    const cl_R difference = (value(f, x + h) - value(f, x - h)) / (2 * h);
    CHECK(cln::abs(slope - difference) < ten_to_minus(35));  // h^2 and 60 digits less 20
  }
}

TEST_CASE("symmetry and value at 0 are as stated in the table") {
  for (const Function& f : function_table) {
    if (f.arity != 1) continue;
    CAPTURE(f.name);
    const cl_R x = Rational(3) / 7;
    if (f.parity == Parity::odd) CHECK(cln::abs(value(f, -x) + value(f, x)) < ten_to_minus(50));
    if (f.parity == Parity::even) CHECK(cln::abs(value(f, -x) - value(f, x)) < ten_to_minus(50));
    if (f.at_zero >= 0) CHECK(cln::abs(value(f, 0) - cl_R(f.at_zero)) < ten_to_minus(50));
  }
}

TEST_CASE("derivatives on the graph are those of the table") {
  Dag dag;
  const Symbol x{SymbolKind::coordinate, 0, 0};
  for (const Function& f : function_table) {
    if (f.arity != 1 || f.op == Op::sign) continue;
    CAPTURE(f.name);
    const Ref r = partial_derivative(dag, x)(dag.call(f.op, dag.symbol(x)));
    const cl_R at = Rational(3) / 7;
    const cl_R found = evaluate(
        dag, {r}, [&](const Symbol&) { return at; }, digits)[0];
    const auto [size, divides, falls] = slope_of(f, at, value(f, at), Numbers{});
    const cl_R slope = (falls ? cl_R(-1) : cl_R(1)) * (divides ? cl_R(1) / size : size);
    CHECK(cln::abs(found - slope) < ten_to_minus(50));
  }
}

TEST_CASE("functions that code may call have a name there, the others are expanded") {
  for (const Function& f : function_table) {
    CAPTURE(f.name);
    const bool written_out =
        f.op == Op::abs || f.op == Op::sign || f.op == Op::min || f.op == Op::max || f.op == Op::select;
    CHECK((f.code == nullptr) == written_out);
    if (f.raised) CHECK_FALSE(std::string(f.latex).empty());
  }
  CHECK_THROWS_AS(function_of(Op::add), std::out_of_range);
}

TEST_CASE("functions in binary64 and in many digits agree") {
  for (const Function& f : function_table) {
    CAPTURE(f.name);
    const double x[] = {0.375, 0.5, 1.25, -2.0};  // powers of 2: exact in both
    const cl_R exact[] = {precise.round(Rational(3) / 8), precise.round(Rational(1) / 2),
                          precise.round(Rational(5) / 4), precise.round(-2)};
    const double rough = value_of(
        f.op, 0, [&](std::size_t i) -> const double& { return x[i]; }, Binary64Arithmetic{});
    const cl_R fine = value_of(
        f.op, 0, [&](std::size_t i) -> const cl_R& { return exact[i]; }, precise);
    CHECK(rough == doctest::Approx(cln::double_approx(fine)).epsilon(1e-15));
  }
}

TEST_CASE("results below the range of CLN's floats are 0") {
  CHECK(cln::zerop(precise.call(Op::exp, -cln::expt(Rational(10), 300))));
  CHECK(cln::plusp(precise.call(Op::exp, -cln::expt(Rational(10), 17))));
}

TEST_CASE("angles whose multiple of pi would fill the memory have no value") {
  const cl_R huge = cln::exp(cln::cl_float(1e11, precise.format));
  for (const Op op : {Op::sin, Op::cos, Op::tan}) {
    CHECK_THROWS_AS(precise.call(op, huge), std::domain_error);
    CHECK_NOTHROW(precise.call(op, cln::expt(Rational(10), 1000)));
  }
}
