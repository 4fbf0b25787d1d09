// SPDX-License-Identifier: GPL-3.0-or-later
// Jumps are applied and reported, or end the run: velocities of supports, steps of a potential, positions.
#include <doctest/doctest.h>

#include <cmath>

#include "support/reference_integration.hpp"
#include "support/run_text.hpp"

using namespace eomgen;

namespace {

constexpr double g = 9.81;

std::string pendulum(const std::string& support) {
  return "[parameters]\nm = 1\nl = 1\na = 1\ng = 9.81\n[coordinates]\nth = \"1\"\n[functions]\ns = \"" + support +
         "\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"s + l*sin(th)\", \"-l*cos(th)\", "
         "0]\n[[force]]\ngravity = \"-g*E2\"\n"
         "[scene.default]\nt = [0, 3]\ninitial = { th = 0.1 }\n";
}

/// The pendulum on a support with uniform velocity except for one jump at t = 1.
std::array<double, 2> expected(double change) {
  const auto f = [](double, const double* x, double* dx) {
    dx[0] = x[1];
    dx[1] = -g * std::sin(x[0]);
    return 0;
  };
  std::vector<double> x = test::integrate_reference(f, 0, {0.1, 0}, 1, 1e-13, 1e-14);
  x[1] -= change * std::cos(x[0]);
  x = test::integrate_reference(f, 1, x, 3, 1e-13, 1e-14);
  return {x[0], x[1]};
}

const run::RunEvent* impulse(const test::FinishedRun& finished) {
  for (const run::RunEvent& event : finished.simulation.result.events) {
    if (event.kind == "impulse") return &event;
  }
  return nullptr;
}

std::string step_at_one(const std::string& potential, double speed) {
  return "[parameters]\nm = 1\n[coordinates]\nx = \"m\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", "
         "0, 0]\n[energy]\npotential = \"" +
         potential + "\"\n[scene.default]\nt = [0, 3]\ninitial = { x_dot = " + std::to_string(speed) + " }\n";
}

}  // namespace

TEST_CASE("jumps: a jump in the velocity of a support gives the pendulum an impulse, and its work is reported") {
  struct Case {
    const char* support;
    double change;
  };
  for (const Case& c : {Case{"a*abs(t - 1)", 2}, Case{"a*max(0, t - 1)", 1}, Case{"if(t < 1, 0, a*(t - 1))", 1},
                        Case{"3 - a*min(1, t)", 1}}) {
    CAPTURE(std::string(c.support));
    const test::FinishedRun finished = test::run_text("support", pendulum(c.support));
    const auto [th, th_dot] = expected(c.change);
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    CHECK(std::abs(finished.final("th") - th) < 1e-7);
    CHECK(std::abs(finished.final("th_dot") - th_dot) < 1e-7);
    REQUIRE(impulse(finished) != nullptr);
    CHECK(std::abs(impulse(finished)->t - 1) < 1e-12);
    CHECK(impulse(finished)->name == "th_dot");
    CHECK(finished.simulation.result.power_balance < 1e-8);
    CHECK(finished.simulation.result.contact_work == doctest::Approx(impulse(finished)->work));
  }
}

TEST_CASE("jumps: the same with a constraint that keeps its multiplier") {
  const test::FinishedRun finished = test::run_text(
      "rod",
      "[parameters]\nm = 1\nl = 1\na = 1\ng = 9.81\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = "
      "[\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n"
      "[[constraint]]\nname = \"rod\"\nholonomic = \"(x - a*abs(t - 1))^2 + y^2 - l^2\"\n[scene.default]\nt = [0, 3]\n"
      "initial = { x = \"1 + sin(0.1)\", y = \"-cos(0.1)\", x_dot = -1, y_dot = 0 }\n");
  const auto [th, th_dot] = expected(2);
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(std::abs(finished.final("x") - (2 + std::sin(th))) < 1e-7);
  CHECK(std::abs(finished.final("y") + std::cos(th)) < 1e-7);
  CHECK(std::abs(finished.final("x_dot") - (1 + std::cos(th) * th_dot)) < 1e-7);
  REQUIRE(impulse(finished) != nullptr);
  CHECK(finished.simulation.result.power_balance < 1e-8);
}

TEST_CASE("jumps: a kink of a support at the start of a run is behind the start") {
  // A support that moves at once with velocity a: in its frame the pendulum starts with th_dot = th_dot_0 + a cos(th),
  // whatever the law does before.
  const auto moved = [](double speed) {
    const auto f = [](double, const double* x, double* dx) {
      dx[0] = x[1];
      dx[1] = -g * std::sin(x[0]);
      return 0;
    };
    return test::integrate_reference(f, 0, {0.1, speed}, 3, 1e-13, 1e-14);
  };
  const auto in_time = [](const std::string& support, const std::string& t0) {
    std::string text = pendulum(support);
    return text.replace(text.find("t = [0, 3]"), 10, "t = [" + t0 + ", \"" + t0 + " + 3\"]");
  };
  for (const auto& [support, t0] : {std::array<std::string, 2>{"a*abs(t)", "0"},
                                    {"max(0, 0.3*t)", "0"},
                                    {"a*abs(t - 1)", "1"},
                                    {"if(t < 0, 3*t, 0.5*t)", "0"},
                                    {"a*abs(1 - t)^3 + t", "1"}}) {
    CAPTURE(support);
    const test::FinishedRun finished = test::run_text("start", in_time(support, t0));
    const std::vector<double> x = moved(0);
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    CHECK(impulse(finished) == nullptr);
    CHECK(finished.simulation.result.power_balance < 1e-8);
    if (support.find('^') == std::string::npos) CHECK(std::abs(finished.final("th") - x[0]) < 1e-7);
  }
  // sin(pi*t) is 1.2e-16 at t = 1, and its root is beside it.
  const test::FinishedRun rounded = test::run_text("start", in_time("max(0, -sin(pi*t))", "1"));
  CHECK(rounded.simulation.result.outcome == eom::Outcome::done);
  CHECK(rounded.simulation.result.power_balance < 1e-8);
  // With multipliers, the rates of the start satisfy the constraint with the velocity behind the kink.
  const test::FinishedRun rod = test::run_text(
      "rod_start",
      "[parameters]\nm = 1\nl = 1\na = 1\ng = 9.81\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = "
      "[\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n"
      "[[constraint]]\nname = \"rod\"\nholonomic = \"(x - a*abs(t - 1))^2 + y^2 - l^2\"\n[scene.default]\nt = [1, 4]\n"
      "initial = { x = \"sin(0.1)\", y = \"-cos(0.1)\", x_dot = 0 }\n");
  const std::vector<double> x = moved(-1 / std::cos(0.1));
  CHECK(rod.simulation.result.outcome == eom::Outcome::done);
  CHECK(rod.simulation.result.projection_velocity < 1e-8);
  CHECK(std::abs(rod.final("x") - (3 + std::sin(x[0]))) < 1e-7);
  CHECK(std::abs(rod.final("y") + std::cos(x[0])) < 1e-7);
}

TEST_CASE("jumps: the impulse of a kink at the end of a run is applied") {
  for (const char* support : {"a*abs(t - 3)", "a*max(0, t - 3)", "if(t < 3, a*t, 2*a*t - 3*a)"}) {
    CAPTURE(std::string(support));
    const test::FinishedRun finished = test::run_text("end", pendulum(support));
    const double change = support[2] == 'a' ? 2 : 1;
    const auto [th, th_dot] = expected(0);
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    CHECK(finished.simulation.result.t == 3);
    CHECK(std::abs(finished.final("th") - th) < 1e-7);
    CHECK(std::abs(finished.final("th_dot") - (th_dot - change * std::cos(th))) < 1e-7);
    REQUIRE(impulse(finished) != nullptr);
    CHECK(impulse(finished)->t == 3);
    CHECK(finished.simulation.result.power_balance < 1e-8);
  }
  // One whose effect is undetermined does not end a run that ends there anyway.
  const test::FinishedRun jump = test::run_text("end", pendulum("if(t < 3, 0, a)"));
  CHECK(jump.simulation.result.outcome == eom::Outcome::done);
  CHECK(impulse(jump) == nullptr);
}

TEST_CASE("jumps: a support whose velocity has a kink but no jump gives no impulse") {
  const test::FinishedRun finished = test::run_text("bends", pendulum("a*max(0, t - 1)^2"));
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  CHECK(impulse(finished) == nullptr);
}

TEST_CASE("jumps: a support whose position jumps ends the run, and is named") {
  const test::FinishedRun finished = test::run_text("place", pendulum("if(t < 1, 0, a)"));
  CHECK(finished.simulation.result.outcome == eom::Outcome::jump_undetermined);
  CHECK(finished.simulation.result.detail.find("P.position1 jumps at t = 1") == 0);
}

TEST_CASE("jumps: a step of a potential ends the run if it is crossed, and has no effect otherwise") {
  const test::FinishedRun crossed = test::run_text("step", step_at_one("if(x < 1, 0, 5)", 4));
  CHECK(crossed.simulation.result.outcome == eom::Outcome::jump_undetermined);
  CHECK(crossed.simulation.result.detail.find("the potential energy jumps by 5") == 0);
  CHECK(std::abs(crossed.final("x") - 1) < 1e-9);
  CHECK(test::run_text("step", step_at_one("if(x < 1, 0, 5)", 0.3)).simulation.result.outcome == eom::Outcome::done);
  CHECK(test::run_text("step", step_at_one("if(x < 1, 0, 5*(x - 1))", 4)).simulation.result.outcome ==
        eom::Outcome::done);
}

TEST_CASE("jumps: a wire with a corner ends the run there") {
  const test::FinishedRun corner = test::run_text("corner",
                                                  "[parameters]\nm = 1\n[coordinates]\nx = \"m\"\n[[particle]]\nname = "
                                                  "\"P\"\nmass = \"m\"\nposition = [\"x\", \"max(0, x - 1)\", 0]\n"
                                                  "[scene.default]\nt = [0, 3]\ninitial = { x_dot = 1 }\n");
  CHECK(corner.simulation.result.outcome == eom::Outcome::jump_undetermined);
  CHECK(corner.simulation.result.detail.find("P.velocity2 jumps by -1 at t = 1") == 0);
}
