// SPDX-License-Identifier: GPL-3.0-or-later
// Features shorter than a step are detected: pulses of forces and inputs, bumps, events in quick succession.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eom/registry.hpp>
#include <numbers>
#include <sstream>

#include "support/run_text.hpp"

using namespace eomgen;

namespace {

std::string particle(const std::string& force, const std::string& more) {
  return "[parameters]\nm = 1\nF = 658\n[coordinates]\nx = \"m\"\n" + more +
         "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n[[force]]\ngeneralized = { x = \"" +
         force + "\" }\n";
}

std::size_t count(const run::RunResult& result, const std::string& kind, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(result.events.begin(), result.events.end(),
                    [&](const run::RunEvent& e) { return e.kind == kind && e.name == name; }));
}

}  // namespace

TEST_CASE(
    "passed over: a force of a millisecond in ten seconds changes the velocity by its integral, with every solver") {
  struct Case {
    const char* force;
    double impulse, allowed;
    bool smooth;
  };
  constexpr double F = 658, w = 1e-3;
  for (const Case& c :
       {Case{"F/(1 + ((t - 5.123)/0.001)^2)", F * w * (std::atan(4.877 / w) + std::atan(5.123 / w)), 1e-6, true},
        Case{"if(abs(t - 5.123) < 0.0005, F, 0)", F * w, 1e-9, false},
        Case{"F*max(0, 1 - abs(t - 5.123)/0.001)", F * w, 1e-9, false}}) {
    CAPTURE(std::string(c.force));
    const test::FinishedRun finished = test::run_text("pulse", particle(c.force, "") + "[scene.default]\nt = [0, 10]\n",
                                                      [](auto& request) { request.every_solver = true; });
    CHECK(std::abs(finished.final("x_dot") - c.impulse) < c.allowed);
    for (const eom::MethodInfo& method : eom::methods()) {
      if (method.needs.required.has(eom::Feature::constraints) ||
          (method.needs.required.has(eom::Feature::momenta) && !c.smooth))
        continue;
      CAPTURE(std::string(method.name));
      run::Overrides overrides;
      overrides.solver = method.name;
      if (!method.adaptive) overrides.step = 0.05;
      const run::RunResult result = pipeline::rerun(finished.simulation, overrides);
      CHECK(result.outcome == eom::Outcome::done);
      const double error = std::abs(test::value_of(result.final, "x_dot") - c.impulse);
      CHECK(error < (method.adaptive ? c.allowed : c.smooth ? 0.02 * c.impulse : c.allowed));
      CHECK(error <= 10 * test::value_of(result.error_estimate, "x_dot") + 1e-9);
    }
  }
}

TEST_CASE("passed over: conditions in inputs are detected, also narrow ones") {
  const std::string text =
      particle("u", "[inputs]\nu = { default = 0 }\n") +
      "[scene.default]\nt = [0, 10]\ninputs = { u = \"if(t < 5, 0, if(t < 5.001, 1000, 0))\" }\n"
      "[scene.kink]\nfrom = \"default\"\ninputs = { u = \"max(0, t - 9)\" }\n"
      "[scene.pulses]\nfrom = \"default\"\ninputs = { u = \"if(cos(2*pi*t) > 0.9999, 1, 0)\" }\n"
      "[scene.table]\nfrom = \"default\"\ninputs = { u = { t = [0, 5, 5.001], value = [0, 1000, 0] } }\n";
  const auto end = [&](const std::string& scene) {
    const test::FinishedRun finished = test::run_text("input", text, [&](auto& request) { request.scene = scene; });
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    return finished.final("x_dot");
  };
  CHECK(std::abs(end("default") - 1) < 1e-9);
  CHECK(std::abs(end("table") - 1) < 1e-9);
  CHECK(std::abs(end("kink") - 0.5) < 1e-9);
  CHECK(std::abs(end("pulses") - 10 * std::acos(0.9999) / std::numbers::pi) <
        1e-9);  // half of the first pulse, nine whole pulses, half of the last
}

TEST_CASE("passed over: every event of a free particle, whose steps are long, is reported") {
  const std::string text =
      "[parameters]\nm = 1\n[coordinates]\nx = \"m\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, "
      "0]\n"
      "[[event]]\nname = \"time\"\nwhen = \"sin(5*t + 1)\"\n[[event]]\nname = \"place\"\nwhen = \"sin(50*x + 1)\"\n"
      "[[event]]\nname = \"narrow\"\nwhen = \"abs(x - 3.3333) - 1e-5\"\n[scene.default]\nt = [0, 10]\ninitial = { "
      "x_dot = 1.1 }\n";
  const test::FinishedRun finished = test::run_text("events", text);
  const run::RunResult& result = finished.simulation.result;
  CHECK(result.outcome == eom::Outcome::done);
  CHECK(count(result, "custom", "time") == 16);    // 51 rad
  CHECK(count(result, "custom", "place") == 175);  // 551 rad
  CHECK(count(result, "custom", "narrow") == 2);
}

TEST_CASE("passed over: a particle that crosses a narrow region of force within a step is affected by it") {
  const test::FinishedRun finished =
      test::run_text("barrier", particle("if(abs(x - 3.3) < 0.01, -20, 0)", "") +
                                    "[scene.default]\nt = [0, 10]\ninitial = { x_dot = 1 }\n");
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(std::abs(finished.final("x_dot") - std::sqrt(1 - 2 * 20 * 0.02)) < 1e-7);
}

TEST_CASE("passed over: a bump that is narrower than a step is detected") {
  const test::FinishedRun finished = test::run_text(
      "bump",
      "[parameters]\nm = 1\n[coordinates]\nx = \"m\"\ny = \"m\"\n[[particle]]\nname = \"P\"\nmass = "
      "\"m\"\nposition = [\"x\", \"y\", 0]\n[[constraint]]\nname = \"floor\"\n"
      "holonomic = \"y - 0.1[m]/(1 + ((x - 3.7[m])/0.025[m])^2)\"\nholds = \"unilateral\"\nrestitution = "
      "1\n[scene.default]\nt = [0, 5]\ninitial = { x = 0, y = 0.05, x_dot = 2, y_dot = 0 }\n");
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(count(finished.simulation.result, "contact", "floor") == 1);
  CHECK(std::abs(finished.final("x_dot")) < 1.99);
}

TEST_CASE("passed over: barriers that are narrow in the state reflect a particle, with every adaptive solver") {
  struct Case {
    const char* potential;
    double x, x_dot;  // at t = 10, of a particle that starts at 0 with speed 1 and reaches the barrier at 3
  };
  // A bump reflects the particle at 3, up to the width of the bump. So does a step of 0.6 J, more than its energy of
  // 1/2 J. The particle crosses a step of 0.4 J and becomes slower.
  for (const Case& c : {Case{"5*exp(-((x - 3)/1e-5)^2)", -4, -1}, Case{"5/(1 + ((x - 3)/1e-5)^4)", -4, -1},
                        Case{"5/(1 + ((x - 3)/1e-8)^2)", -4, -1}, Case{"0.3*tanh((x - 3)/1e-5) + 0.3", -4, -1},
                        Case{"0.2*tanh((x - 3)/1e-5) + 0.2", 3 + 7 * std::sqrt(0.2), std::sqrt(0.2)}}) {
    CAPTURE(std::string(c.potential));
    const test::FinishedRun finished =
        test::run_text("narrow",
                       "[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"" +
                           std::string(c.potential) + "\"\n[scene.default]\nt = [0, 10]\ninitial = { x_dot = 1 }\n",
                       [](auto& request) { request.every_solver = true; });
    for (const eom::MethodInfo& method : eom::methods()) {
      if (method.needs.keeps_constraints || !method.adaptive) continue;
      CAPTURE(std::string(method.name));
      run::Overrides overrides;
      overrides.solver = method.name;
      const run::RunResult result = pipeline::rerun(finished.simulation, overrides);
      CHECK(result.outcome == eom::Outcome::done);
      CHECK(std::abs(test::value_of(result.final, "x") - c.x) < 2e-3);
      CHECK(std::abs(test::value_of(result.final, "x_dot") - c.x_dot) < 1e-6);
    }
    run::Overrides fixed;
    fixed.solver = "rk4";
    fixed.step = 0.29;  // no step ends at 3
    CHECK(pipeline::rerun(finished.simulation, fixed).estimate_note.find("narrow in the state") != std::string::npos);
  }
}

TEST_CASE("passed over: the estimate counts narrow forces below the tolerances that bound steps") {
  // The particle crosses the force at x = 0, and changes its speed by 2 w/speed there.
  for (const double width : {1e-8, 1e-9}) {
    for (const char* start : {"1", "0.7", "0.913"}) {
      CAPTURE(width);
      CAPTURE(std::string(start));
      std::ostringstream text;
      text << "[parameters]\nw = " << width
           << "\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[[force]]\ngeneralized = { x = "
              "\"-1/sqrt(1 + (x/w)^2)^3\" }\n[scene.default]\nt = [0, 4]\ninitial = { x = "
           << start << ", x_dot = -1 }\n";
      const test::FinishedRun finished = test::run_text("passed", text.str());
      const run::RunResult& result = finished.simulation.result;
      CHECK(result.outcome == eom::Outcome::done);
      const double speed = std::sqrt(1 + 4 * width), error = std::abs(finished.final("x_dot") + speed);
      const double x0 = std::atof(start), error_x = std::abs(finished.final("x") + speed * (4 - x0));
      const double estimate = test::value_of(result.error_estimate, "x_dot");
      CHECK(error <= estimate + 1e-15);
      CHECK(error_x <= test::value_of(result.error_estimate, "x") + 1e-15);
      CHECK(estimate <= 3e-8 + 20 * width);  // a tolerance that bounds steps, or the size of the change
    }
  }
}

TEST_CASE("passed over: rates of states of first order are narrow too") {
  for (const char* rate : {"1/sqrt(1 + (x/w)^2)^3", "exp(-(x/w)^2)", "1/(1 + (x/w)^2)"}) {
    CAPTURE(std::string(rate));
    const test::FinishedRun finished = test::run_text(
        "narrow_rate",
        std::string("[parameters]\nw = 1e-6\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[[state]]\n"
                    "name = \"z\"\nrate = \"") +
            rate + "\"\ninitial = 0\n[scene.default]\nt = [0, 4]\ninitial = { x = 1, x_dot = -1 }\n");
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    const double whole = rate[0] == 'e' ? std::sqrt(std::acos(-1.0)) : rate[2] == 's' ? 2 : std::acos(-1.0);
    CHECK(std::abs(finished.final("z") / 1e-6 - whole) < 2e-3);
  }
}

TEST_CASE("passed over: a softened barrier of a width of 1e-8 reflects a particle") {
  const test::FinishedRun finished = test::run_text(
      "softened",
      "[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"5/sqrt(1 + ((x - 3)/1e-8)^2)^3\"\n"
      "[scene.default]\nt = [0, 10]\ninitial = { x_dot = 1 }\nsolver = \"dop853\"\n");
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(std::abs(finished.final("x") + 4) < 1e-5);
}

TEST_CASE("passed over: a quotient whose divisor overflows is the limit that it has as written") {
  // x_ddot = -F, as 1 - c/cosh(1000) is 1.
  for (const char* law :
       {"1 - c/cosh(z)", "1 - c/(1 + exp(z))", "1 - c*exp(-z) - c/exp(z)", "1 - c/sinh(z)^2 - c/sinh(z)"}) {
    CAPTURE(std::string(law));
    const test::FinishedRun finished = test::run_text(
        "overflow",
        std::string("[parameters]\nm = 1\nc = 0.5\nF = \"1 N\"\n[coordinates]\nx = \"m\"\n[definitions]\nz = "
                    "\"x/(0.001[m])\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, "
                    "0]\n[[force]]\non = \"P\"\nforce = [\"-F*(") +
            law + ")\", 0, 0]\n[scene.default]\nt = [0, 1]\ninitial = { x = 1, x_dot = -0.1 }\n");
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    CHECK(std::abs(finished.final("x") - 0.4) < 1e-9);
  }
}

TEST_CASE("passed over: a narrow force in a difference of coordinates keeps its digits") {
  // 0.3/w/(1 + ((x - 1)/w)^2) is narrow at x = 1, and w^2 + x^2 - 2 x + 1 consists of rounding there. The integral of
  // the force is 0.3 (atan((x - 1)/w) + atan(1/w)).
  const test::FinishedRun finished =
      test::run_text("difference", particle("0.3/1e-7/(1 + ((x - 1[m])/(1e-7[m]))^2)", "") +
                                       "[scene.default]\nt = [0, 3]\ninitial = { x = 0, x_dot = 1 }\n");
  REQUIRE(finished.simulation.result.outcome == eom::Outcome::done);
  const double x = finished.final("x");
  const double exact = std::sqrt(1 + 0.6 * (std::atan((x - 1) / 1e-7) + std::atan(1 / 1e-7)));
  CHECK(std::abs(finished.final("x_dot") - exact) < 1e-8);
  CHECK(finished.simulation.result.statistics.steps < 1000);
}

TEST_CASE("passed over: implicit methods take differences where a derivative overflows and the force does not") {
  // d/dx of c/cosh(x) is c sinh(x)/cosh(x)^2, inf/inf at x = 800, where the force is 1.
  const test::FinishedRun finished = test::run_text("steep", particle("1[N] - 2[N]/cosh(x/(1[m]))", "") +
                                                                 "[scene.default]\nsolver = \"radau5\"\nt = [0, 2]\n"
                                                                 "initial = { x = 800, x_dot = 0 }\n");
  REQUIRE(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(finished.final("x") == doctest::Approx(802).epsilon(1e-12));
  CHECK(finished.simulation.result.statistics.difference_evaluations > 0);
}

TEST_CASE("passed over: a kink narrower than the digits of the state is refused for that reason") {
  const test::FinishedRun finished = test::run_text(
      "kink", particle("-0.3[N]/1e-8*max(0, 1 - ((x - 1[m])/(1e-8[m]))^2)", "") +
                  "[scene.default]\nt = [0, 3]\nrtol = 1e-12\natol = 1e-14\ninitial = { x = 0, x_dot = 1 }\n");
  const run::RunResult& result = finished.simulation.result;
  if (result.outcome == eom::Outcome::done) {
    CHECK(finished.final("x_dot") == doctest::Approx(std::sqrt(0.2)).epsilon(1e-6));
  } else {
    CHECK(result.outcome == eom::Outcome::step_too_small);
    CHECK(result.detail.find("rounding of the state hides its side") != std::string::npos);
  }
}
