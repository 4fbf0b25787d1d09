// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of handwritten models in the form of the C ABI: the runtime without the generator.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/run.hpp>
#include <eom/hybrid/segments.hpp>
#include <string>
#include <vector>

#include "hybrid/ball.hpp"
#include "lib/compiled.hpp"

using namespace eom::hybrid;

namespace {

/// x'' = -sign(x) with a frozen branch of the kink; g: an event at x_dot, then the kink.
namespace corner {

int rhs(double, const double* x, const double*, const double*, const int* mode, double* dx) {
  const double side = mode[0] != 0 ? mode[0] : x[0] > 0 ? 1 : x[0] < 0 ? -1 : 0;
  dx[0] = x[1];
  dx[1] = -side;
  return 0;
}
int outputs(double, const double* x, const double*, const double*, const int*, double* y) {
  y[0] = x[0], y[1] = x[1];
  y[2] = x[1] * x[1] / 2, y[3] = std::abs(x[0]), y[4] = y[2] + y[3];
  return 0;
}
int events(double, const double* x, const double*, const double*, const int*, double* g) {
  g[0] = x[1], g[1] = x[0];
  return 0;
}

Code code() {
  Code code;
  code.rhs = rhs, code.outputs = outputs, code.events = events;
  code.output_names = {"x", "x_dot", "kinetic", "potential", "energy"};
  code.free = {0};
  code.kinks = {"sign"};
  return code;
}

Problem problem(const Code& code) {
  Problem problem;
  problem.code = &code;
  problem.t1 = 20;
  problem.start = {0.5, 0};
  problem.solver = "dop853";
  problem.kinetic = 2, problem.potential = 3, problem.energy = 4;
  problem.invariants = {{"energy", 4, {}, true}};
  problem.events = {{"turns", eom::Direction::any, false}};
  problem.state_names = {"x", "x_dot"};
  return problem;
}

}  // namespace corner

/// x'' = u.
int pushed(double, const double* x, const double*, const double* u, const int*, double* dx) {
  const double force = u[0];
  dx[0] = x[1];
  dx[1] = force;
  return 0;
}

std::size_t count(const RunResult& result, const std::string& kind) {
  return static_cast<std::size_t>(
      std::count_if(result.events.begin(), result.events.end(), [&](const Event& e) { return e.kind == kind; }));
}

}  // namespace

TEST_CASE("hybrid: a ball bounces at the times of its closed form, and rests after their accumulation") {
  const Code code = ball::code();
  Problem problem = ball::problem(code, 0.5);
  const RunResult result = run(problem);
  REQUIRE(result.outcome == eom::Outcome::done);
  const double fall = std::sqrt(2 / ball::gravity);
  double hit = fall, speed = ball::gravity * fall;
  std::size_t seen = 0;
  for (const Event& event : result.events) {
    CHECK(event.kind == "contact");
    if (seen == 12) break;
    CHECK(event.t == doctest::Approx(hit).epsilon(1e-10));
    speed *= 0.5;
    hit += 2 * speed / ball::gravity;
    ++seen;
  }
  CHECK(seen == 12);
  CHECK(result.events.back().t == doctest::Approx(3 * fall).epsilon(1e-6));  // fall (1 + 2 e/(1 - e))
  CHECK(std::abs(result.state[0]) < 1e-12);
  CHECK(std::abs(result.state[1]) < 1e-12);
  CHECK(result.impulse_work == doctest::Approx(-ball::gravity));  // all of the energy
}

TEST_CASE("hybrid: a ball without restitution does not bounce") {
  const Code code = ball::code();
  Problem problem = ball::problem(code, 0);
  const RunResult result = run(problem);
  REQUIRE(result.outcome == eom::Outcome::done);
  REQUIRE(result.events.size() == 1);
  CHECK(result.events[0].t == doctest::Approx(std::sqrt(2 / ball::gravity)).epsilon(1e-12));
  CHECK(result.error.max < 1e-8);
}

TEST_CASE("hybrid: a kink is crossed at its surface and counted; recorded events have their own rows") {
  const Code code = corner::code();
  Problem problem = corner::problem(code);
  problem.output_interval = 0.7;
  std::vector<double> times;
  problem.row = [&](double t, std::span<const double>) { times.push_back(t); };
  const RunResult result = run(problem);
  REQUIRE(result.outcome == eom::Outcome::done);
  // A quarter of the period is 1: the surface is crossed at 1, 3, 5, .., and the motion turns at 2, 4, ..
  CHECK(result.kink_crossings[0] == 10);
  CHECK(count(result, "custom") >= 9);
  for (const Event& event : result.events) {
    CHECK(std::abs(event.t - 2 * std::round(event.t / 2)) < 1e-9);
    CHECK(std::find(times.begin(), times.end(), event.t) != times.end());
  }
  CHECK(std::is_sorted(times.begin(), times.end()));
  CHECK(result.state[0] == doctest::Approx(0.5).epsilon(1e-9));
  CHECK(result.invariants[0].max_relative_drift < 1e-12);
}

TEST_CASE("hybrid: rows follow steps that are shorter than their interval") {
  const Code code = corner::code();
  const auto times_of = [&](double interval, std::uint32_t subdivisions) {
    Problem problem = corner::problem(code);
    problem.max_step = 0.5;
    problem.output_interval = interval;
    problem.row_subdivisions = subdivisions;
    std::vector<double> times;
    problem.row = [&](double t, std::span<const double>) { times.push_back(t); };
    const RunResult result = run(problem);
    REQUIRE(result.outcome == eom::Outcome::done);
    for (const Event& event : result.events) std::erase(times, event.t);  // events have rows of their own
    return times;
  };
  // Nothing changes where steps are longer.
  CHECK(times_of(0.01, 32) == times_of(0.01, 1));
  const std::vector<double> few = times_of(8, 1), all = times_of(8, 32);
  for (const double t : few) CHECK(std::find(all.begin(), all.end(), t) != all.end());
  std::size_t long_gaps = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    CHECK(all[i] > all[i - 1]);
    CHECK((std::fmod(all[i], 0.25) == 0 || i + 1 == all.size()));
    if (all[i] - all[i - 1] > 0.5) ++long_gaps;
  }
  CHECK(long_gaps <= 1);  // the first steps
  // As many as the subdivisions allow.
  CHECK(times_of(8, 4).size() <= 4 * few.size());
}

TEST_CASE("hybrid: if an event stops the run, the error estimate includes the time") {
  const Code code = corner::code();
  Problem problem = corner::problem(code);
  problem.events[0].stop = true;
  const RunResult result = run(problem);
  CHECK(result.outcome == eom::Outcome::stopped_by_event);
  CHECK(result.t == doctest::Approx(2).epsilon(1e-12));
  CHECK(result.state[0] == doctest::Approx(-0.5).epsilon(1e-12));
  REQUIRE(result.error.t);
  CHECK(*result.error.t < 1e-9);
}

TEST_CASE("hybrid: segments end at the jumps of a table, with the value of each side") {
  Code code = corner::code();
  code.kinks.clear();
  code.events = nullptr;
  code.rhs = pushed;
  Problem problem = corner::problem(code);
  problem.events.clear();
  problem.invariants.clear();
  problem.inputs = {{{}, {0, 1, 1.5}, {1, -2, 0}}};
  problem.start = {0, 0};
  problem.t1 = 2;
  const RunResult result = run(problem);
  REQUIRE(result.outcome == eom::Outcome::done);
  CHECK(std::abs(result.state[1]) < 1e-13);                        // 1 - 2/2
  CHECK(result.state[0] == doctest::Approx(0.75).epsilon(1e-13));  // 1/2 + 1/4
  REQUIRE(segments(problem).size() == 3);
  CHECK(segments(problem)[1].end == 1.5);
}

TEST_CASE("hybrid: df/dt is that of the code for constant or jumping inputs, and by differences for varying ones") {
  Code code = corner::code();
  code.kinks.clear();
  code.events = nullptr;
  code.rhs = pushed;
  code.jac = [](double, const double*, const double*, const double*, const int*, double* dfdx, double* dfdt) {
    const double all[4] = {0, 0, 1, 0};
    std::copy(all, all + 4, dfdx);
    if (dfdt != nullptr) dfdt[0] = dfdt[1] = 0;
    return 0;
  };
  Problem problem = corner::problem(code);
  problem.events.clear();
  problem.invariants.clear();
  problem.start = {0, 0};
  problem.t1 = 2;
  problem.solver = "rodas";
  problem.inputs = {{{}, {0, 1}, {1, -2}}};
  const RunResult jumps = run(problem);
  REQUIRE(jumps.outcome == eom::Outcome::done);
  CHECK(jumps.statistics.jacobians > 0);
  CHECK(jumps.statistics.difference_evaluations == 0);
  CHECK(jumps.state[1] == doctest::Approx(-1));
  problem.inputs = {{[](double t) { return std::sin(t); }}};
  const RunResult moves = run(problem);
  REQUIRE(moves.outcome == eom::Outcome::done);
  CHECK(moves.statistics.difference_evaluations == 2 * moves.statistics.jacobians);  // two for each
  CHECK(moves.state[1] == doctest::Approx(1 - std::cos(2.0)).epsilon(1e-8));
}

TEST_CASE("hybrid: a coordinate that leaves its range ends the run with the previous step") {
  const Code code = corner::code();
  Problem problem = corner::problem(code);
  problem.ranges = {{-0.25, 1}};
  const RunResult result = run(problem);
  CHECK(result.outcome == eom::Outcome::chart_left);
  CHECK(result.reason.kind == Reason::Kind::range);
  CHECK(result.reason.index == 0);
  CHECK(result.t == result.reason.from);
  CHECK(result.detail == sentence(result.reason));
  CHECK(result.state[0] >= -0.25);
}

TEST_CASE("hybrid: an unknown solver, and one whose functions the code lacks, are refused") {
  const Code code = corner::code();
  Problem problem = corner::problem(code);
  problem.solver = "dopri9";
  CHECK_THROWS_AS(run(problem), std::invalid_argument);
  for (const char* solver : {"taylor", "variational4", "ggl"}) {
    problem.solver = solver;
    problem.fixed_step = 0.1;
    CHECK_THROWS_WITH_AS(run(problem), doctest::Contains(solver), std::invalid_argument);
  }
  CHECK_THROWS_WITH_AS(run(problem), doctest::Contains("a model with constraints"), std::invalid_argument);
  Code no_contacts = ball::code();
  no_contacts.events = nullptr;
  CHECK_THROWS_WITH_AS(run(ball::problem(no_contacts, 0.5)), doctest::Contains("no function events"),
                       std::invalid_argument);
}
