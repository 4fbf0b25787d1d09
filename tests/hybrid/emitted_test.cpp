// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of emitted code with only the runtime produce the bytes of `eomgen run`, also if they evaluate expressions:
// inputs, functions of time, jumps, bounds along a step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/external_steps.hpp>
#include <eom/hybrid/run.hpp>
#include <eom/hybrid/stepwise_run.hpp>
#include <eom/output/csv.hpp>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "driven_run.hpp"
#include "lib/compiled.hpp"
#include "sampled_run.hpp"
#include "step_run.hpp"
#include "support_run.hpp"
#include "wire_run.hpp"

namespace {

const std::string made = EOMGEN_EMITTED_RUNS;  // from the build: code, and tables of `eomgen run`

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs the problem, writes its rows to a table, and compares this byte for byte with the table of the given name.
eom::hybrid::RunResult same_bytes(const std::string& table, eom::hybrid::Problem problem,
                                  const std::vector<std::size_t>& columns) {
  std::vector<std::string> names;
  for (const std::size_t column : columns) names.push_back(problem.code->output_names[column]);
  std::vector<double> values(columns.size());
  const std::string path = made + "/" + table + ".runtime.csv";
  eom::CsvWriter rows(path, names);
  problem.row = [&](double t, std::span<const double> outputs) {
    for (std::size_t i = 0; i < columns.size(); ++i) values[i] = outputs[columns[i]];
    rows.row(t, values);
  };
  eom::hybrid::RunResult result = eom::hybrid::run(problem);
  rows.finish(result.outcome);
  CHECK(bytes_of(path) == bytes_of(made + "/" + table + ".csv"));
  return result;
}

}  // namespace

TEST_CASE(
    "emitted runs: an input as a function of t, a narrow barrier and an event between samples give the bytes of run") {
  const eom::hybrid::Code code = driven_code();
  const eom::hybrid::RunResult result = same_bytes("driven", driven_problem(code), driven_columns());
  CHECK(result.outcome == eom::Outcome::done);
  REQUIRE(result.events.size() == 2);
  CHECK(result.events[1].t - result.events[0].t < 1e-5);
  // The series would ignore the input.
  eom::hybrid::Problem series = driven_problem(code);
  series.solver = "taylor";
  CHECK_THROWS_AS(eom::hybrid::run(series), std::invalid_argument);
}

TEST_CASE("emitted runs: a jump of a support's velocity and a pulse are resolved, also with other parameters") {
  const eom::hybrid::Code code = support_code();
  const eom::hybrid::RunResult result = same_bytes("support", support_problem(code), support_columns());
  REQUIRE(result.events.size() == 1);
  CHECK(result.events[0].kind == "impulse");
  CHECK(result.events[0].t == doctest::Approx(1).epsilon(1e-15));
  eom::hybrid::Problem other = support_problem(code);
  other.parameters[3] = 0.4;  // t0
  other.parameters[4] = 1.3;  // t1
  CHECK(same_bytes("support_other", other, support_columns()).events.at(0).t == doctest::Approx(0.4).epsilon(1e-15));
}

TEST_CASE("emitted runs: periods and offsets of samples follow from parameters, as in run") {
  const eom::hybrid::Code code = sampled_code();
  eom::hybrid::Problem other = sampled_problem(code);
  other.parameters[2] = 0.25;  // T
  const eom::hybrid::RunResult result = same_bytes("sampled_other", other, sampled_columns());
  // Samples at 1/12 + k/4: four. Those of the period 0.1 would be ten.
  REQUIRE(code.discrete == 1);
  CHECK(result.state[2] == 4);
  other.parameters[2] = -1;
  CHECK_THROWS_WITH_AS(eom::hybrid::run(other), doctest::Contains("the period of 'sample 1' is -1"),
                       std::invalid_argument);

  // In pieces, with the period changed on the way: 1/30, 4/30, .., then 0.25/3 + k/4 from t = 0.55 on.
  eom::hybrid::StepwiseRun run(sampled_problem(code));
  CHECK(run.advance(0.55, {}).outcome == eom::Outcome::done);
  CHECK(run.state().back() == 6);
  std::vector<double> p = sampled_problem(code).parameters;
  p[2] = 0;
  CHECK_THROWS_AS(run.set_parameters(p), std::invalid_argument);
  p[2] = 0.25;
  run.set_parameters(p);
  CHECK(run.advance(0.57, {}).outcome == eom::Outcome::done);
  CHECK(run.state().back() == 6);
  CHECK(run.advance(1, {}).outcome == eom::Outcome::done);
  CHECK(run.state().back() == 8);  // 0.5833, 0.8333

  // The same for a caller that integrates itself.
  eom::hybrid::ExternalSteps steps(sampled_problem(code));
  CHECK(steps.next_event_time() == doctest::Approx(0.1 / 3));
  steps.set_parameters(p, 0, sampled_problem(code).start);
  CHECK(steps.next_event_time() == doctest::Approx(0.25 / 3));
}

TEST_CASE("samples: one at the time of a change of the period is taken once") {
  using eom::hybrid::Sample;
  Sample before{"s", 0.1, 0}, now{"s", 0.25, 0};
  CHECK(eom::hybrid::last_taken(before, 4, now, 0.5) == 1);  // the one at 0.5 is still to come
  CHECK(eom::hybrid::last_taken(before, 5, now, 0.5) == 2);  // it was taken
  CHECK(eom::hybrid::last_taken(before, 4, now, 0.45) == 1);
  CHECK(eom::hybrid::last_taken(before, eom::hybrid::none_taken, now, 0) == -1);
}

TEST_CASE("emitted runs: a potential that jumps ends the run with its reason") {
  const eom::hybrid::Code code = step_code();
  const eom::hybrid::RunResult result = same_bytes("step", step_problem(code), step_columns());
  CHECK(result.outcome == eom::Outcome::jump_undetermined);
  CHECK(result.reason.kind == eom::hybrid::Reason::Kind::branch_jump);
  CHECK(result.reason.amount == -3);
  CHECK(result.detail.find("the potential energy jumps by -3") != std::string::npos);
}

TEST_CASE("emitted runs: a coordinate may leave its range if the equations hold beyond it") {
  const eom::hybrid::Code code = wire_code();
  const eom::hybrid::RunResult result = same_bytes("wire", wire_problem(code), wire_columns());
  CHECK(result.outcome == eom::Outcome::done);
  CHECK(std::abs(result.outputs[0] - (0.5 * std::cosh(2.0) - std::sinh(2.0))) < 1e-7);
}
