// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in pieces of handwritten models with closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <eom/hybrid/stepwise_run.hpp>
#include <string>
#include <vector>

#include "hybrid/ball.hpp"
#include "lib/compiled.hpp"

using namespace eom::hybrid;

namespace {

/// q'' = -q + u, with an event at q.
namespace oscillator {

int rhs(double, const double* x, const double* p, const double* u, const int*, double* dx) {
  const double acceleration = -p[0] * x[0] + u[0];
  dx[0] = x[1];
  dx[1] = acceleration;
  return 0;
}
int outputs(double, const double* x, const double* p, const double*, const int*, double* y) {
  y[0] = x[0], y[1] = x[1];
  y[2] = x[1] * x[1] / 2, y[3] = p[0] * x[0] * x[0] / 2, y[4] = y[2] + y[3];
  return 0;
}
int events(double, const double* x, const double*, const double*, const int*, double* g) {
  g[0] = x[0];
  return 0;
}

Code code() {
  Code code;
  code.rhs = rhs, code.outputs = outputs, code.events = events;
  code.output_names = {"q", "q_dot", "kinetic", "potential", "energy"};
  code.free = {0};
  return code;
}

Problem problem(const Code& code) {
  Problem problem;
  problem.code = &code;
  problem.parameters = {1};
  problem.t1 = 10;
  problem.start = {1, 0};
  problem.inputs = {{{}, {0}, {0}, {}}};
  problem.solver = "dop853";
  problem.rtol = 1e-12, problem.atol = 1e-13;
  problem.kinetic = 2, problem.potential = 3, problem.energy = 4;
  problem.events = {{"zero", eom::Direction::any, false}};
  problem.state_names = {"q", "q_dot"};
  return problem;
}

}  // namespace oscillator

}  // namespace

TEST_CASE("stepwise run: pieces give the closed form, the events and the rows of one run") {
  const Code code = oscillator::code();
  Problem problem = oscillator::problem(code);
  std::vector<double> times, rows;
  problem.output_interval = 0.25;
  problem.row = [&](double t, std::span<const double> y) {
    times.push_back(t);
    rows.push_back(y[0]);
  };
  StepwiseRun run(problem);
  std::vector<double> zeros;
  const StepwiseRun::Piece piece{false, nullptr, [&](const Event& event, std::span<const double>) {
                                   CHECK(event.name == "zero");
                                   zeros.push_back(event.t);
                                 }};
  for (int k = 1; k <= 100; ++k) {
    const eom::Result end = run.advance(0.1 * k, piece);
    REQUIRE(end.outcome == eom::Outcome::done);
    CHECK(run.t() == 0.1 * k);
    CHECK(end.x == run.state());
    CHECK(run.state()[0] == doctest::Approx(std::cos(0.1 * k)).epsilon(1e-10));
  }
  REQUIRE(zeros.size() == 3);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(zeros[k] == doctest::Approx((static_cast<double>(k) + 0.5) * M_PI).epsilon(1e-11));
  REQUIRE(times.size() == 41);
  for (std::size_t k = 0; k < times.size(); ++k) {
    CHECK(times[k] == 0.25 * static_cast<double>(k));
    CHECK(rows[k] == doctest::Approx(std::cos(times[k])).epsilon(1e-9));
  }
  CHECK(run.advance(3, piece).outcome == eom::Outcome::done);  // the past: nothing happens
  CHECK(run.t() == 10);
}

TEST_CASE("stepwise run: inputs are held or functions of time, and parameters change, from the next piece on") {
  const Code code = oscillator::code();
  StepwiseRun run(oscillator::problem(code));
  run.set_input(0, {{}, {0}, {1}, {}});  // at rest at q = 1
  REQUIRE(run.advance(2, {}).outcome == eom::Outcome::done);
  CHECK(run.state()[0] == doctest::Approx(1).epsilon(1e-12));
  run.set_input(0, {[](double t) { return std::cos(2 * (t - 2)); }, {}, {}, {}});
  REQUIRE(run.advance(3, {}).outcome == eom::Outcome::done);
  // q'' + q = cos 2s, q(0) = 1, q'(0) = 0: q = 4/3 cos s - 1/3 cos 2s
  CHECK(run.state()[0] == doctest::Approx(4 * std::cos(1.0) / 3 - std::cos(2.0) / 3).epsilon(1e-10));
  CHECK(run.inputs()[0] == doctest::Approx(std::cos(2.0)).epsilon(1e-15));
  const double stiffness = 4;
  run.set_input(0, {{}, {3}, {0}, {}});
  run.set_parameters({&stiffness, 1});
  const std::vector<double> x = run.state();
  REQUIRE(run.advance(3.7, {}).outcome == eom::Outcome::done);
  CHECK(run.state()[0] == doctest::Approx(x[0] * std::cos(1.4) + x[1] / 2 * std::sin(1.4)).epsilon(1e-10));
}

TEST_CASE("stepwise run: single steps grow to the length that the tolerances allow, and take few evaluations more") {
  const Code code = oscillator::code();
  Problem problem = oscillator::problem(code);
  problem.t1 = 50;
  const RunResult whole = eom::hybrid::run(problem);
  StepwiseRun run(problem);
  std::size_t steps = 0;
  double longest = 0;
  while (run.t() < 50) {
    const double from = run.t();
    const eom::Result end = run.advance(1e4, {true, nullptr, {}});
    REQUIRE(end.outcome == eom::Outcome::done);
    REQUIRE(end.statistics.steps == 1);
    longest = std::max(longest, run.t() - from);
    ++steps;
  }
  CHECK(run.state()[0] == doctest::Approx(std::cos(run.t())).epsilon(1e-9));
  CHECK(longest > 0.1);
  CHECK(steps < whole.statistics.steps * 11 / 10);
  StepwiseRun fixed([&] {
    problem.fixed_step = 0.01;
    return problem;
  }());
  REQUIRE(fixed.advance(1e4, {true, nullptr, {}}).outcome == eom::Outcome::done);
  CHECK(fixed.t() == 0.01);
}

TEST_CASE("stepwise run: a ball bounces, rests, leaves with the input and falls again, in pieces of any length") {
  const Code code = ball::code();
  for (const double piece : {0.001, 0.07, 1.0}) {
    CAPTURE(piece);
    StepwiseRun run(ball::problem(code, 0.5));
    std::size_t impacts = 0;
    const StepwiseRun::Piece how{false, nullptr, [&](const Event& event, std::span<const double>) {
                                   impacts += event.kind == "contact" ? 1 : 0;
                                 }};
    const auto until = [&](double t_end) {
      while (run.t() < t_end) REQUIRE(run.advance(std::min(t_end, run.t() + piece), how).outcome == eom::Outcome::done);
    };
    const double fall = std::sqrt(2 / ball::gravity);
    until(1.5 * fall);  // the top of the first bounce
    CHECK(run.state()[0] == doctest::Approx(0.25).epsilon(1e-9));
    CHECK(impacts == 1);
    until(3);
    CHECK(run.state()[0] == doctest::Approx(0).scale(1).epsilon(1e-12));
    CHECK(run.state()[1] == 0);
    CHECK(impacts > 5);
    impacts = 0;
    run.set_input(0, {{}, {3}, {12}, {}});
    until(4);
    CHECK(run.state()[0] == doctest::Approx(1).epsilon(1e-9));
    run.set_input(0, {{}, {4}, {0}, {}});
    until(4.6);  // z = 1 + 2 s - 5 s^2 is 0 at s = 0.69
    CHECK(run.state()[0] == doctest::Approx(1 + 1.2 - 1.8).epsilon(1e-9));
    CHECK(impacts == 0);
  }
}

TEST_CASE("stepwise run: a restored run continues with the same bits, between bounces and at rest") {
  const Code code = ball::code();
  for (const double t : {0.3, 1.2, 1.34, 2.0}) {
    CAPTURE(t);
    StepwiseRun run(ball::problem(code, 0.5));
    REQUIRE(run.advance(t, {}).outcome == eom::Outcome::done);
    const StepwiseRun::State saved = run.save();
    std::vector<std::vector<double>> ends;
    for (StepwiseRun* which : {&run, &run}) {
      which->restore(saved);
      CHECK(which->t() == t);
      REQUIRE(which->advance(t + 0.4, {}).outcome == eom::Outcome::done);
      REQUIRE(which->advance(t + 1, {}).outcome == eom::Outcome::done);
      ends.push_back(which->state());
    }
    StepwiseRun other(ball::problem(code, 0.5)), straight(ball::problem(code, 0.5));
    other.restore(saved);
    other.advance(t + 0.4, {});
    other.advance(t + 1, {});
    straight.advance(t, {});
    straight.advance(t + 0.4, {});
    straight.advance(t + 1, {});
    CHECK(ends[0] == ends[1]);
    CHECK(other.state() == ends[0]);
    CHECK(straight.state() == ends[0]);
  }
}

TEST_CASE("stepwise run: a run that begins anew takes its contacts from the state") {
  const Code code = ball::code();
  StepwiseRun run(ball::problem(code, 0.5));
  const double rest[] = {0, 0}, above[] = {0.5, 0};
  CHECK(run.gaps(0, rest) == std::vector<double>{0});
  CHECK(run.gaps(0, above) == std::vector<double>{0.5});
  run.restart(7, rest, {false});
  REQUIRE(run.advance(8, {}).outcome == eom::Outcome::done);
  CHECK(run.state() == std::vector<double>{0, 0});
  run.restart(7, above, {true});
  REQUIRE(run.advance(7.3, {}).outcome == eom::Outcome::done);
  CHECK(run.state()[0] == doctest::Approx(0.5 - 5 * 0.09).epsilon(1e-9));
}

TEST_CASE("stepwise run: a coordinate that leaves its range ends the piece before it, with the reason") {
  const Code code = oscillator::code();
  Problem problem = oscillator::problem(code);
  problem.ranges = {{0.5, 2}};
  StepwiseRun run(problem);
  REQUIRE(run.advance(1, {}).outcome == eom::Outcome::done);
  const eom::Result end = run.advance(2, {});
  CHECK(end.outcome == eom::Outcome::chart_left);
  CHECK(end.detail.find("q leaves its range (0.5, 2)") != std::string::npos);
  CHECK(run.state()[0] > 0.5);
  CHECK(run.reason().kind == Reason::Kind::range);
}

TEST_CASE("stepwise run: a piece that ends at a kink in time ends behind it, and later pieces begin where it ended") {
  const Code code = oscillator::code();
  Problem problem = oscillator::problem(code);
  problem.breakpoints = {{std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0)}};
  StepwiseRun run(problem);
  REQUIRE(run.advance(1, {}).outcome == eom::Outcome::done);
  CHECK(run.t() > 1);
  CHECK(run.t() == doctest::Approx(1).epsilon(1e-15));
  CHECK(run.advance(1, {}).outcome == eom::Outcome::done);
  for (const double end : {1.25, 1.5, 2.0}) {
    REQUIRE(run.advance(end, {}).outcome == eom::Outcome::done);
    CHECK(run.t() == end);
    CHECK(run.state()[0] == doctest::Approx(std::cos(end)).epsilon(1e-10));
  }
}
