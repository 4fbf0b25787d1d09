// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of emitted code with only the runtime produce the bytes of `eomgen run`, also if they evaluate expressions:
// inputs, functions of time, jumps, bounds along a step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/run.hpp>
#include <eom/output/csv.hpp>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "driven_run.hpp"
#include "lib/compiled.hpp"
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
