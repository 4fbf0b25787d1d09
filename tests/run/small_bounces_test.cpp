// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts at the limits of binary64: bounces too low to resolve, a start next to the floor, speeds whose squares
// overflow.
#include <doctest/doctest.h>

#include <cmath>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using symbolic::Rational;

namespace {

Rational ten_to(long exponent) { return cln::expt(Rational(10), cln::cl_I(exponent)); }

const char* const small_ball =
    "format = 1\n[parameters]\nm = 1\ng = 9.81\nh = \"1 m\"\nv = \"3 m/s\"\ne = { value = 0.5, unit = \"1\" }\nmu = { "
    "value = 0.1, unit = \"1\" }\n"
    "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = "
    "\"-g*E2\"\n"
    "[[constraint]]\nname = \"floor\"\nholonomic = \"y\"\nholds = \"unilateral\"\nrestitution = \"e\"\nfriction = { "
    "static = \"mu\", dynamic = \"mu\" }\n"
    "[scene.default]\nt = [0, 3]\ninitial = { y = \"h\", x_dot = \"v\" }\n";

const test::FinishedRun& made() {
  static const test::FinishedRun finished = [] {
    const std::string path = test::build_folder() + "/small_bounces.toml";
    test::write_text(path, small_ball);
    return test::run_model(path);
  }();
  return finished;
}

run::RunResult with(std::map<std::string, Rational> parameters) {
  run::Overrides overrides;
  overrides.values = std::move(parameters);
  return pipeline::rerun(made().simulation, overrides);
}

}  // namespace

TEST_CASE("small bounces: with any coefficient of restitution the ball comes to rest on the floor and then slides on") {
  constexpr double g = 9.81, mu = 0.1, v = 3;
  const double falls = std::sqrt(2 / g);
  for (const long exponent : {-1L, -2L, -3L, -5L, -6L, -7L, -8L, -10L, -14L, -100L, -300L}) {
    CAPTURE(exponent);
    const run::RunResult result = with({{"e", ten_to(exponent)}});
    const double e = std::pow(10, static_cast<double>(exponent)), lies = falls * (1 + 2 * e / (1 - e));
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(std::abs(test::value_of(result.final, "y")) < 1e-12);
    CHECK(std::abs(test::value_of(result.final, "x_dot") - (v - mu * g * (3 - lies))) < 1e-9);
    CHECK(test::value_of(result.error_estimate, "max") < 1e-8);
  }
}

TEST_CASE("small bounces: a start next to the floor counts as a start on the floor") {
  for (const long exponent : {-12L, -15L, -20L, -100L, -300L}) {
    CAPTURE(exponent);
    const run::RunResult result = with({{"h", ten_to(exponent)}});
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(std::abs(test::value_of(result.final, "y")) < 1e-11);
    CHECK(std::abs(test::value_of(result.final, "x_dot") - (3 - 0.981 * 3)) < 1e-5);
  }
}

TEST_CASE("small bounces: a speed whose square overflows is reported at once") {
  const run::RunResult result = with({{"v", ten_to(300)}});
  CHECK(result.outcome != eom::Outcome::done);
  CHECK(result.statistics.steps + result.statistics.rejected < 1000);
}
