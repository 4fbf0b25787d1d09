// SPDX-License-Identifier: GPL-3.0-or-later
// integral(e): closed forms and states against the oracle, which integrates by quadrature; and the quadrature against
// known values.
#include <doctest/doctest.h>

#include <string>

#include "derive/imposition.hpp"
#include "oracle/quadrature.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

struct Checked {
  bool pass = false;
  double worst = 1;
  std::size_t states = 0;
};

// A bead on a vertical wire, and one on a rod whose end moves: the integral in an imposed and in an active constraint.
Checked check(const std::string& integral, bool active) {
  const std::string psi = active ? "x^2 + z^2 + (y - (" + integral + "))^2 - 4" : "z - (" + integral + ")";
  const std::string text = R"toml(
format = 1
[parameters]
m = 1.5
g = 9.81
a = 0.7
w = 1.3
b = 0.4
[functions]
f = "a*sin(w*t + b)"
s = "1 + f^2"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "c"
holonomic = ")toml" + psi + R"toml("
[scene.default]
t = [0.5, 3]
initial = { x = 1, y = 0.3 }
)toml";
  const model::Model model = model::read_model_text(text, "integral.toml");
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  const verify::Certificate c = verify::verify(mechanics, {50, 2, 1});
  Checked result{c.pass, 0, derive::first_order_states(mechanics).size()};
  for (const verify::Comparison& row : c.comparisons)
    result.worst = std::max(result.worst, row.max_relative_difference);
  return result;
}

}  // namespace

TEST_CASE("integrals: integrals with a known rule have a closed form, which agrees with quadrature to 45 digits") {
  bool active = false;
  for (const std::string integral : {"integral(1)",
                                     "integral(a*t^3 - b*t + 2)",
                                     "integral(sin(w*t + b))",
                                     "integral(t^2*cos(w*t))",
                                     "integral(t^3*sin(w*t + b))",
                                     "integral(exp(-b*t))",
                                     "integral(t^2*exp(-b*t))",
                                     "integral(exp(-b*t)*cos(w*t + a))",
                                     "integral(t^2*exp(b*t)*sin(w*t))",
                                     "integral(sin(w*t)^2)",
                                     "integral(sin(w*t)*cos(a*t))",
                                     "integral(cos(w*t)^3)",
                                     "integral(1/(a*t + b))",
                                     "integral(t/(a*t + b)^2)",
                                     "integral(t^2/(a*t + b))",
                                     "integral(sqrt(a*t + b))",
                                     "integral(t*(a*t + b)^(2/3))",
                                     "integral((a*t + b)^20)",
                                     "integral(1/sqrt(a*t + 1))",
                                     "integral(sinh(w*t)*cosh(b*t))",
                                     "integral(2^t)",
                                     "integral((t + exp(-t))*(t - exp(-t)))",
                                     "integral(f)",
                                     "integral(s)",
                                     "integral(f_dot)",
                                     "integral(f*f_dot)",
                                     "integral(integral(f))",
                                     "integral(t*integral(exp(-t)))",
                                     "integral(t/(t^2 + b^2))",
                                     "integral(1/(t^2 + 3))",
                                     "integral(t*exp(-b*t^2))",
                                     "integral(t/(t^2 - 40))",
                                     "integral(t/sqrt(t^2 + a))",
                                     "integral(f_dot/(2 + f))",
                                     "integral((2*t + 1)/(t^2 + t - 90))",
                                     "integral(exp(b*t)/exp(w*t))",
                                     "integral(ddt(s*t))",
                                     "integral(1/(t*(t*t)))"}) {
    CAPTURE(integral);
    active = !active;
    const Checked found = check(integral, active);
    CHECK(found.pass);
    CHECK(found.worst < 1e-45);
    CHECK(found.states == 0);
  }
}

TEST_CASE("integrals: any other integral is a state, alone or nested, and agrees with quadrature") {
  const std::pair<std::string, std::size_t> all[] = {
      {"integral(exp(-t^2))", 1},      {"integral(sin(w*t^2))", 1},        {"integral(sqrt(1 + s^2))", 1},
      {"integral(sin(t)/t)", 1},       {"integral(integral(exp(-s)))", 2}, {"integral(t) + integral(tanh(f))", 1},
      {"integral(log(a*t + b))", 1},   {"integral(1/(t^2 + b))", 1},       {"integral(abs(t - 1)*sign(t - 1))", 1},
      {"integral(sqrt(t)*exp(-t))", 1}};
  for (const auto& [integral, states] : all) {
    const auto& shown = integral;
    CAPTURE(shown);
    for (const bool active : {false, true}) {
      const Checked found = check(integral, active);
      CHECK(found.pass);
      CHECK(found.worst < 1e-45);
      CHECK(found.states == states);
    }
  }
}

TEST_CASE("integrals: the quadrature gives pi, log 2 and a kink to the requested digits") {
  using verify::Real;
  for (const int digits : {20, 60, 120}) {
    const verify::Precision precision(digits + 10);
    const verify::GaussLegendre quadrature(digits, precision);
    const Real tolerance = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(digits - 1));
    const auto one = [&](int value) { return precision.round(Real(value)); };
    const Real pi = quadrature([](const Real& x) { return 4 / (1 + x * x); }, one(0), one(1));
    CHECK(cln::abs(pi - cln::pi(precision.format)) < tolerance);
    const Real log2 = quadrature([](const Real& x) { return 1 / x; }, one(2), one(1));
    CHECK(cln::abs(log2 + cln::ln(one(2))) < tolerance);
    const Real kink = quadrature([&](const Real& x) { return cln::abs(3 * x - 1); }, one(0), one(1));
    CHECK(cln::abs(kink - one(5) / 6) < tolerance);
  }
  const verify::Precision precision(60);
  const verify::GaussLegendre quadrature(50, precision);
  CHECK_THROWS_AS(quadrature([](const Real& x) { return 1 / x; }, precision.round(Real(-1)), precision.round(Real(2))),
                  verify::Singular);
}
