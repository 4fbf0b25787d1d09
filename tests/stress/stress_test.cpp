// SPDX-License-Identifier: GPL-3.0-or-later
// The verdicts of stress: accurate results pass, inaccurate ones with a warning or a large estimate are reported, and
// wrong results with a small estimate are undetected.
#include "stress/stress.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace eomgen;

namespace {

double rate = 1;  // of the oscillator in the functions below

int rhs(double, const double* x, const double*, const double*, const int*, double* dx) {
  dx[0] = x[1];
  dx[1] = -rate * rate * x[0];
  return std::isfinite(dx[1]) ? 0 : 5;
}
int outputs(double, const double* x, const double*, const double*, const int*, double* y) {
  y[0] = x[0];
  y[1] = x[1];
  y[3] = x[1] * x[1] / 2;
  y[4] = rate * rate * x[0] * x[0] / 2;
  y[2] = y[3] + y[4];
  return 0;
}

struct Oscillator {
  Oscillator() {
    rate = 1;
    code.rhs = rhs;
    code.outputs = outputs;
    code.output_names = {"x", "x_dot", "energy", "kinetic", "potential"};
    code.free = {0};
    scene.t1 = 3;
    scene.parameters = {1};
    scene.q = {1};
    scene.qdot = {0};
    scene.lower = {-std::numeric_limits<double>::infinity()};
    scene.upper = {std::numeric_limits<double>::infinity()};
    request.run = [this](const run::Scene& s) {
      return run::RunRequest{code, s, {"x", "x_dot"}, {}, {}, false, true, 0, {}, {}, nullptr};
    };
    request.solvers = {"dopri5", "dop853", "radau5", "rk4"};
    request.seconds_limit = 1e9;  // rows must not depend on the load of the machine
  }

  run::Code code;
  run::Scene scene;
  stress::Request request;
  std::string why;
};

}  // namespace

TEST_CASE("stress: solvers with error control pass an easy motion, with their true error") {
  Oscillator o;
  const std::vector<stress::Row> rows = stress::assess({.name = "as it is"}, o.scene, o.request, o.why);
  CHECK(o.why.empty());
  REQUIRE(rows.size() == 4);
  for (const stress::Row& row : rows) {
    CAPTURE(row.solver);
    CHECK(row.verdict == (row.solver == "rk4" ? stress::Verdict::reported : stress::Verdict::pass));
    CHECK(row.outcome == "done");
    CHECK(row.error < 1e-7);
    CHECK(row.condition >= 1);
    CHECK(row.condition < 10);  // disturbances of an oscillator rotate and do not grow
  }
}

TEST_CASE("stress: a wrong result with a small estimate is undetected") {
  Oscillator o;
  o.request.progress = [](const std::string&) {
    rate = 1.001;
  };  // from here on the runs, no longer their reference solution
  for (const stress::Row& row : stress::assess({.name = "another motion"}, o.scene, o.request, o.why)) {
    CAPTURE(row.solver);
    CHECK(row.verdict == stress::Verdict::undetected);
    CHECK(row.error > 1e-4);
    CHECK(row.estimate < 1e-5);
  }
}

TEST_CASE(
    "stress: if no motion exists an outcome other than done is reported, and done is undetected; a parameter that is "
    "not a number is reported") {
  Oscillator o;
  const stress::Case test{.name = "p = nan", .has_no_motion = true};
  const auto all = [&](stress::Verdict verdict) {
    const std::vector<stress::Row> rows = stress::assess(test, o.scene, o.request, o.why);
    CHECK(rows.size() == 4);
    for (const stress::Row& row : rows) CHECK(row.verdict == verdict);
  };
  all(stress::Verdict::undetected);
  o.scene.parameters = {std::numeric_limits<double>::infinity()};  // the right-hand side does not check parameters
  all(stress::Verdict::reported);
  o.scene.parameters = {1};
  rate = std::numeric_limits<double>::quiet_NaN();
  all(stress::Verdict::reported);
}

TEST_CASE(
    "stress: budgets are steps: a run beyond them is reported, and a motion without a reference to its end is "
    "evaluated "
    "over a shorter span") {
  Oscillator o;
  o.request.solvers = {"dopri5"};
  o.scene.t1 = 3000;
  o.request.steps_limit = 2000;
  const std::vector<stress::Row> rows = stress::assess({.name = "long"}, o.scene, o.request, o.why);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].note.find("until t = ") == 0);
  CHECK(rows[0].verdict != stress::Verdict::undetected);
  o.scene.t1 = 300;
  o.scene.rtol = o.scene.atol =
      1e-15;  // dop853 and radau5 reach the end with their tolerances, dopri5 does not with this one
  o.request.steps_limit = 50000;
  const std::vector<stress::Row> slower = stress::assess({.name = "long"}, o.scene, o.request, o.why);
  REQUIRE(slower.size() == 1);
  CHECK(slower[0].outcome == "max_steps");
  CHECK(slower[0].verdict == stress::Verdict::reported);
}

TEST_CASE("stress: fixed steps that damp unresolved oscillations are detected by intermediate states, not by the end") {
  Oscillator o;
  o.request.solvers = {"rk4"};
  o.request.steps_limit = 1000000;
  rate = 1000;  // 2000 steps: of 1.5 each in the phase, 9 % of the amplitude lost in one
  const std::vector<stress::Row> rows = stress::assess({.name = "fast"}, o.scene, o.request, o.why);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].error > 0.5);
  CHECK(rows[0].estimate > 0.1);
  CHECK(rows[0].note.find("do not resolve the motion") != std::string::npos);
  CHECK(rows[0].verdict == stress::Verdict::reported);
}

TEST_CASE("stress: if the clock ends a tight run the case is skipped, and this is reported") {
  Oscillator o;
  o.request.seconds_limit = -1;
  CHECK(stress::assess({.name = "as it is"}, o.scene, o.request, o.why).empty());
  CHECK(o.why.find("time limit") != std::string::npos);
}

TEST_CASE("stress: variations match the constants of the model") {
  const model::Model model = model::read_model_text(
      "format = 1\n[parameters]\nm = \"2 kg\"\nk = \"8 N/m\"\nL = \"1 m\"\n[[particle]]\nname = \"P\"\nmass = "
      "\"m\"\nposition = { cylindrical = [\"r\", \"theta\"] }\n"
      "[[force]]\nspring = { between = [\"origin\", \"P\"], stiffness = \"k\", length = \"L\" }\n[scene.default]\nt = "
      "[0, 1]\ninitial = { r = 1, theta_dot = 1 }\n",
      "spring.toml");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  run::Scene scene;
  scene.parameters = {2, 8, 1};
  scene.q = {1, 0};
  scene.qdot = {0, 1};
  scene.lower = {0, -std::numeric_limits<double>::infinity()};
  scene.upper = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const std::vector<stress::Case> all = stress::make_cases(m, scene, false);
  const auto has = [&](const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const stress::Case& c) { return c.name == name; });
  };
  for (const char* name : {"as it is", "m x 1e-09", "m x 1e+09", "k x 1e+12", "r at 0 + 1e-15", "speed x 1e+06",
                           "rtol 1e-15", "span x 100", "from rest", "m = nan", "L = inf"}) {
    CAPTURE(std::string(name));
    CHECK(has(name));
  }
  CHECK_FALSE(has("L x 1e+06"));  // a length is neither a stiffness nor a mass
  CHECK(stress::make_cases(m, scene, true).size() < all.size() / 2);
}
