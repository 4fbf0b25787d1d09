// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/jet.hpp"

#include <cln/rational.h>
#include <doctest/doctest.h>

#include <functional>

#include "verify/near.hpp"

using namespace eomgen::verify;
using eomgen::verify::test::near;

namespace {

const Precision p(60);

Real at(int numerator, int denominator) { return p.round(cln::cl_RA(numerator) / denominator); }

/// f', f'' at x, read from two nested levels.
std::pair<Real, Real> derivatives(const std::function<Jet(const Jet&)>& f, const Real& x) {
  const Jet once = Jet::variable(1, Jet(x), 0);
  const Jet twice = Jet::on_level(2, once, {Jet(1)});
  const Jet y = f(twice);
  return {y.slope(2, 0).real(), y.slope(2, 0).slope(1, 0).real()};
}

}  // namespace

TEST_CASE("jets: first and second derivatives of every elementary function are the closed forms") {
  const Real x = at(37, 100);
  const Real s = cln::sin(x), c = cln::cos(x), e = cln::exp(x), ln = cln::ln(p.round(x));
  const Real root = cln::sqrt(p.round(1 - x * x)), one = 1;
  const Real sh = cln::sinh(x), ch = cln::cosh(x), th = sh / ch, tg = s / c;
  struct Row {
    const char* name;
    std::function<Jet(const Jet&)> f;
    Real first, second;
  };
  const Row rows[] = {
      {"sin", [](const Jet& j) { return sin_cos(j, p).first; }, c, -s},
      {"cos", [](const Jet& j) { return sin_cos(j, p).second; }, -s, -c},
      {"tan", [](const Jet& j) { return tan(j, p); }, 1 + tg * tg, 2 * tg * (1 + tg * tg)},
      {"asin", [](const Jet& j) { return asin(j, p); }, 1 / root, x / (root * root * root)},
      {"acos", [](const Jet& j) { return acos(j, p); }, -1 / root, -x / (root * root * root)},
      {"atan", [](const Jet& j) { return atan(j, p); }, 1 / (1 + x * x), -2 * x / ((1 + x * x) * (1 + x * x))},
      {"sinh", [](const Jet& j) { return sinh_cosh(j, p).first; }, ch, sh},
      {"cosh", [](const Jet& j) { return sinh_cosh(j, p).second; }, sh, ch},
      {"tanh", [](const Jet& j) { return tanh(j, p); }, 1 - th * th, -2 * th * (1 - th * th)},
      {"exp", [](const Jet& j) { return exp(j, p); }, e, e},
      {"log", [](const Jet& j) { return log(j, p); }, 1 / x, -1 / (x * x)},
      {"sqrt", [](const Jet& j) { return sqrt(j, p); }, 1 / (2 * cln::sqrt(p.round(x))),
       -1 / (4 * x * cln::sqrt(p.round(x)))},
      {"x^5", [](const Jet& j) { return power(j, Jet(5), p); }, 5 * x * x * x * x, 20 * x * x * x},
      {"x^-2", [](const Jet& j) { return power(j, Jet(-2), p); }, -2 / (x * x * x), 6 / (x * x * x * x)},
      {"x^x", [](const Jet& j) { return power(j, j, p); }, cln::exp(x * ln) * (ln + 1),
       cln::exp(x * ln) * ((ln + 1) * (ln + 1) + one / x)},
  };
  for (const Row& row : rows) {
    CAPTURE(row.name);
    const auto [first, second] = derivatives(row.f, x);
    CHECK(near(first, row.first, 55));
    CHECK(near(second, row.second, 55));
  }
}

TEST_CASE("jets: products, quotients and compositions nest without confusing the levels") {
  // f = x y / (x + y^2) with x on level 1, y on level 2: the mixed derivative
  const Real x = at(3, 2), y = at(-4, 5);
  const Jet X = Jet::variable(1, Jet(x), 0), Y = Jet::variable(2, Jet(y), 0);
  const Jet f = X * Y / (X + Y * Y);
  const Real n = x + y * y;
  CHECK(near(f.value(2).slope(1, 0).real(), y * y * y / (n * n), 55));
  CHECK(near(f.slope(2, 0).value(1).real(), x * (x - y * y) / (n * n), 55));
  CHECK(near(f.slope(2, 0).slope(1, 0).real(), (3 * x * y * y - y * y * y * y) / (n * n * n), 55));
}

TEST_CASE("jets: atan2 has the derivatives of the angle in every quadrant") {
  for (const int sx : {-1, 1})
    for (const int sy : {-1, 1}) {
      const Real x = at(7 * sx, 10), y = at(2 * sy, 5), square = x * x + y * y;
      const Jet X = Jet::variable(1, Jet(x), 0), Y = Jet::variable(1, Jet(y), 1);
      const Jet angle = atan2(Y, X, p);
      CHECK(near(angle.slope(1, 0).real(), -y / square, 55));
      CHECK(near(angle.slope(1, 1).real(), x / square, 55));
      CHECK(near(sin_cos(angle, p).first.real() * cln::sqrt(p.round(square)), y, 55));
    }
}

TEST_CASE("jets: numbers below the float range are 0, and subnormal numbers keep their value") {
  const Real far = -cln::expt(cln::cl_RA(10), cln::cl_I(300));
  CHECK(exp(Jet::variable(1, Jet(far), 0), p).is_exactly_zero());
  CHECK(bool(exact(5e-324) * cln::expt(cln::cl_RA(2), cln::cl_I(1074)) == 1));
}

TEST_CASE("jets: angles whose multiple of pi would fill the memory have no value") {
  CHECK_THROWS_AS(sin_cos(exp(Jet(Real(100000000000)), p), p), Singular);
}

TEST_CASE("jets: points without a derivative are rejected, exact zeros stay exact") {
  CHECK_THROWS_AS(Jet(1) / Jet(), Singular);
  CHECK_THROWS_AS(log(Jet(-1), p), Singular);
  CHECK_THROWS_AS(sqrt(Jet(-1), p), Singular);
  CHECK_THROWS_AS(sqrt(Jet::variable(1, Jet(0), 0), p), Singular);
  CHECK_THROWS_AS(asin(Jet::variable(1, Jet(1), 0), p), Singular);
  CHECK_THROWS_AS(atan2(Jet(), Jet(), p), Singular);
  CHECK_THROWS_AS(power(Jet(-2), Jet(Real(cln::cl_RA(1) / 2)), p), Singular);
  const Jet x = Jet::variable(3, Jet(at(1, 3)), 0);
  CHECK((Jet() * x).is_exactly_zero());
  CHECK((x - x).level() == 0);
  CHECK(power(Jet(Real(cln::cl_RA(2) / 3)), Jet(3), p).real() == cln::cl_RA(8) / 27);
}
