// SPDX-License-Identifier: GPL-3.0-or-later
// Simplification preserves values and finds the forms that a person would find.
#include <doctest/doctest.h>

#include "reading/by_name.hpp"
#include "reading/rational_function.hpp"
#include "reading/small_matrix.hpp"
#include "reading/trig.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::power;
using reading::simplify;

namespace {

System some_symbols() {
  return System(model::read_model_text(R"(format = 1
[parameters]
m = { value = 1, positive = true }
k = 1
[coordinates]
a = {}
b = {}
phi = { range = [0, "pi"] }
x = {}
y = {}
[energy]
kinetic = "m*k*(a_dot^2 + b_dot^2 + phi_dot^2 + x_dot^2 + y_dot^2)/2"
)",
                                       "symbols"));
}

}  // namespace

TEST_CASE("trigonometry: squares and angle differences are recombined") {
  System s = some_symbols();
  const Sum a = s.symbol("a"), b = s.symbol("b"), m = s.symbol("m"), x = s.symbol("x");
  CHECK(simplify(square(sin(a)) + square(cos(a))) == Sum(1));
  CHECK(simplify(m * square(sin(a)) * x + m * square(cos(a)) * x) == m * x);
  CHECK(simplify(Sum(1) - square(sin(a))) == square(cos(a)));
  CHECK(simplify(power(sin(a), 4) + Sum(2) * square(sin(a)) * square(cos(a)) + power(cos(a), 4)) == Sum(1));
  CHECK(simplify(cos(a) * cos(b) + sin(a) * sin(b)) == cos(a - b));
  CHECK(simplify(cos(a) * cos(b) - sin(a) * sin(b)) == cos(a + b));
  CHECK(simplify(sin(a) * cos(b) - cos(a) * sin(b)) == sin(a - b));
  CHECK(simplify(m * x * (sin(a) * cos(b) + cos(a) * sin(b))) == m * x * sin(a + b));
  CHECK(simplify(cos(a + b) * cos(a) + sin(a + b) * sin(a)) == cos(b));
  CHECK(simplify(sin(b) * cos(a) - cos(b) * sin(a)) == -sin(a - b));
}

TEST_CASE("signs: products of x, |x| and sign(x) have one form") {
  System s = some_symbols();
  const Sum a = s.symbol("a"), m = s.symbol("m"), x = sin(a);
  const auto abs = [](const Sum& of) { return reading::call(reading::Op::abs, {of}); };
  const auto sign = [](const Sum& of) { return reading::call(reading::Op::sign, {of}); };
  CHECK(simplify(m * square(x) * power(abs(x), -1)) == m * abs(x));
  CHECK(simplify(x * power(abs(x), -1)) == sign(x));
  CHECK(simplify(sign(x) * abs(x)) == x);
  CHECK(simplify(square(sign(x))) == Sum(1));
  CHECK(simplify(x * sign(x)) == abs(x));
  CHECK(simplify(power(abs(x), 2)) == square(x));
  CHECK(simplify(cos(a) * x - cos(a) * abs(x) * sign(x)).is_zero());
  CHECK(simplify(power(x, 3) * power(abs(x), -1)) == square(x) * sign(x));
  CHECK(simplify(abs(x) * sign(m)) == abs(x) * sign(m));
}

TEST_CASE("trigonometry: the shorter of the two forms is kept, and nothing gets longer") {
  System s = some_symbols();
  const Sum a = s.symbol("a"), m = s.symbol("m"), k = s.symbol("k"), x = s.symbol("x");
  const Sum kinetic = square(cos(a)) * x + square(sin(a)) * x + square(sin(a)) * m;
  CHECK(simplify(kinetic) == x + m * square(sin(a)));
  const Sum mixed = k * square(cos(a)) + m * square(sin(a));
  CHECK(simplify(mixed).size() == 2);
  CHECK(same(simplify(mixed), mixed));
}

TEST_CASE("trigonometry: squares with roots, divisors and high powers of sines keep their value") {
  System s = some_symbols();
  const Sum a = s.symbol("a"), b = s.symbol("b"), m = s.symbol("m"), k = s.symbol("k"), x = s.symbol("x");
  const Sum third = power(x, reading::Rational(1) / 3), root = power(sin(a), reading::Rational(1) / 2);
  CHECK(simplify(root * square(sin(b)) * third + root * square(cos(b)) * third) == root * third);
  CHECK(simplify(root * square(cos(a)) - root) == -(root * square(sin(a))));
  CHECK(simplify(over(square(cos(a)), sin(b)) * k - over(k, sin(b))) == -(k * over(square(sin(a)), sin(b))));
  CHECK(simplify(over(Sum(1), sin(a)) - over(square(cos(a)), sin(a))) == sin(a));
  CHECK(simplify(square(cos(a)) * power(m, -3) - power(m, -3)) == -(square(sin(a)) * power(m, -3)));
  Sum eighth(1);  // (sin^2 + cos^2)^8 of two angles
  for (const Sum& angle : {a, b}) eighth = eighth * power(square(sin(angle)) + square(cos(angle)), 4);
  CHECK(eighth.size() == 25);
  CHECK(simplify(eighth) == Sum(1));
  const Sum mixed = power(sin(a), 5) * cos(b) + power(sin(a), 3) * square(cos(a)) * cos(b) + x * square(sin(b));
  CHECK(simplify(mixed) == power(sin(a), 3) * cos(b) + x * square(sin(b)));
}

TEST_CASE("roots: sqrt(x^2) is x if x is positive, and |x| if its sign is unknown") {
  System s = some_symbols();
  const Sum m = s.symbol("m"), x = s.symbol("x"), phi = s.symbol("phi");
  CHECK(sqrt(square(m)) == m);
  CHECK(sqrt(Sum(4) * square(m)) == Sum(2) * m);
  CHECK(sqrt(square(x)) == reading::call(symbolic::Op::abs, {x}));
  CHECK(sqrt(square(m * sin(phi))) == m * sin(phi));  // phi lies between 0 and pi
  CHECK(sqrt(x) * sqrt(x) == x);
  CHECK(square(reading::call(symbolic::Op::abs, {x})) == square(x));
}

TEST_CASE("signs: -1 is pulled out of functions and of sums under a power") {
  System s = some_symbols();
  const Sum x = s.symbol("x"), y = s.symbol("y");
  CHECK(sin(y - x) == -sin(x - y));
  CHECK(cos(y - x) == cos(x - y));
  CHECK(power(y - x, -1) == -power(x - y, -1));
  CHECK(power(y - x, -2) == power(x - y, -2));
  CHECK(power(Sum(2) * y - Sum(2) * x, -1) == reading::Rational(-1) / 2 * power(x - y, -1));
}

TEST_CASE("quotients: common factors cancel, denominators are factored") {
  System s = some_symbols();
  const Sum x = s.symbol("x"), y = s.symbol("y"), a = s.symbol("a"), m = s.symbol("m");
  const Sum u = square(x) + square(y);
  CHECK(reading::quotient(u * x * y, u) == x * y);
  CHECK(reading::quotient(square(x) - square(y), x + y) == x - y);
  CHECK(reading::quotient(x, square(x) * u + u) == x * power(square(x) + Sum(1), -1) * power(u, -1));
  CHECK(simplify(square(x) * power(u, -1) + square(y) * power(u, -1)) == Sum(1));
  CHECK(same(over(m, Sum(1) + square(sin(a))) * (Sum(2) - square(cos(a))), m));
  CHECK_THROWS_AS(power(Sum(), -1), std::domain_error);
  const auto parts = reading::factorise(square(x) * square(y) * power(u, 2) * Sum(-6));
  CHECK(parts.sign == -1);
  REQUIRE(parts.factors.size() == 1);
  CHECK(parts.factors[0].first == u);
  CHECK(parts.factors[0].second == 2);
}

TEST_CASE(
    "exact quotients: found where there is one, beside roots and divisors that all terms have, and nowhere else") {
  System s = some_symbols();
  const Sum x = s.symbol("x"), y = s.symbol("y"), a = s.symbol("a"), m = s.symbol("m"), k = s.symbol("k");
  const Sum u = square(x) + square(y), v = power(x, 4) + square(y);
  const Sum root = power(u, reading::Rational(-1) / 2), other = power(v, reading::Rational(-1) / 2);
  const auto divides = [](const Sum& p, const Sum& q) {
    const std::optional<Sum> found = reading::exact_quotient(p * q, q);
    return found && *found == p;
  };
  for (const Sum& p : {x, x - Sum(2) * y, m * u + k * v, u * v + sin(a) * x + Sum(7), power(x + y + k, 5)}) {
    for (const Sum& q : {u, Sum(3) * x * y - v, x + m, square(sin(a)) - k * u, Sum(reading::Rational(2) / 3) * x}) {
      CHECK(divides(p, q));
      CHECK(reading::exact_quotient(p * q + k, q).has_value() == (q.size() == 1));  // a single term always divides
    }
  }
  CHECK(reading::exact_quotient(x * u * other, u) == x * other);
  CHECK(reading::exact_quotient(x * u * power(m, -2) * root, v) == std::nullopt);
  CHECK(reading::exact_quotient(power(u, reading::Rational(1) / 2) * x + square(y) * x * root + power(x, 3) * root,
                                u) == Sum(2) * x * root);  // sqrt(u) = u/sqrt(u), expanded
  CHECK(reading::exact_quotient(x + m, u) == std::nullopt);
  CHECK(reading::exact_quotient(Sum(), u) == Sum());
  CHECK(reading::exact_quotient(over(u, x), u) == power(x, -1));
}

TEST_CASE("factors: sums with an atom in one term alone have none, others are found") {
  System s = some_symbols();
  const Sum x = s.symbol("x"), y = s.symbol("y"), m = s.symbol("m"), k = s.symbol("k"), a = s.symbol("a");
  const auto count = [](const Sum& sum) { return reading::factorise(sum).factors.size(); };
  CHECK(count(m * square(x) + k * y) == 1);
  CHECK(count(Sum(4) * m * k * square(x) + Sum(6) * m * y * x) == 1);  // beside the content m x
  CHECK(count(k + m * square(x + y)) == 1);
  CHECK(count((k + m * x) * (k - sin(a) * y)) == 2);
  CHECK(count((x + y) * (x - y) * m) == 2);
  CHECK(count(m * k + m * x + y * k + y * x) == 2);
  CHECK(count(square(square(x) + square(y)) * (m * square(a) + k * square(a) + m * x + k * y)) == 2);
}

TEST_CASE("factors: sums of degree 1 in an atom are settled without lifting, in any order of symbols") {
  System system = some_symbols();
  const Sum a = system.symbol("a"), b = system.symbol("b"), c = system.symbol("x"), d = system.symbol("y");
  const Sum p = system.symbol("m"), q = system.symbol("k"), r = system.symbol("phi"), s = sin(a);
  // The products of Euler parameters a, b, c, d with rates p, q, r, s in a spring's force.
  const Sum force = q * square(a) * b - power(c, 3) * r - d * s * square(b) - a * square(c) * p - q * square(c) * b -
                    square(d) * a * p + d * s * square(c) - q * power(b, 3) - c * r * square(b) - power(a, 3) * p +
                    Sum(2) * d * c * p * b + Sum(2) * d * q * a * c - d * square(a) * s + Sum(2) * d * a * r * b -
                    square(d) * q * b + a * p * square(b) + square(d) * c * r + Sum(2) * a * s * c * b -
                    power(d, 3) * s - square(a) * c * r;
  // Each factorisation has new symbols. In some processes, GiNaC lifts its image for minutes.
  for (int i = 0; i < 200; ++i) REQUIRE(reading::factorise(force).factors.size() == 1);
}

TEST_CASE("matrices: diagonal blocks are inverted one by one, in any order of rows") {
  System s = some_symbols();
  const Sum x = s.symbol("x"), y = s.symbol("y"), m = s.symbol("m"), k = s.symbol("k");
  // Rows 0 and 2 form a block, row 1 another.
  const std::vector<Sum> matrix = {m, Sum(), x, Sum(), k, Sum(), y, Sum(), Sum(2)};
  const Sum block = Sum(2) * m - x * y;
  CHECK(reading::determinant(matrix, 3) == k * block);
  const std::vector<Sum> inverse = reading::inverse_matrix(matrix, 3);
  CHECK(inverse[0] == over(Sum(2), block));
  CHECK(inverse[2] == over(-x, block));
  CHECK(inverse[6] == over(-y, block));
  CHECK(inverse[8] == over(m, block));
  CHECK(inverse[4] == over(Sum(1), k));
  for (const std::size_t zero : {1, 3, 5, 7}) CHECK(inverse[zero].is_zero());
  // The masses of 60 free particles: without blocks, the cofactors take minutes.
  constexpr std::size_t n = 180;
  std::vector<Sum> masses(n * n);
  for (std::size_t i = 0; i < n; ++i) masses[i * n + i] = m;
  const std::vector<Sum> inverted = reading::inverse_matrix(masses, n);
  for (std::size_t i = 0; i < n; ++i) REQUIRE(inverted[i * n + i] == over(Sum(1), m));
}

TEST_CASE("zero test: proven, numerical, no") {
  System s = some_symbols();
  const Sum a = s.symbol("a"), b = s.symbol("b"), x = s.symbol("x");
  CHECK(reading::zero_test(sin(Sum(3) * a) - Sum(3) * sin(a) + Sum(4) * power(sin(a), 3)) ==
        reading::ZeroTestResult::proven);
  CHECK(reading::zero_test(sin(a + b) - sin(a) * cos(b) - cos(a) * sin(b)) == reading::ZeroTestResult::proven);
  CHECK(reading::zero_test(sin(a) - cos(a)) == reading::ZeroTestResult::no);
  const Sum hyperbolic =
      square(reading::call(symbolic::Op::cosh, {x})) - square(reading::call(symbolic::Op::sinh, {x})) - Sum(1);
  CHECK(reading::zero_test(hyperbolic) == reading::ZeroTestResult::numerical);
  CHECK(reading::zero_test(reading::call(symbolic::Op::log, {-square(x)})) == reading::ZeroTestResult::unknown);
}
