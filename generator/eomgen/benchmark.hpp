// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmark of solvers (error against run time) and stress test of solvers.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

/// Options of Model::benchmark().
struct BenchmarkOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};  // replace the scene's values; SI units
  std::optional<double> t_end = {};               // s; replaces the scene's
  std::vector<std::string> solvers = {};          // empty: all eligible solvers
  double max_seconds = 10;                        // time limit of a run, s
  bool other_libraries = false;                   // also measure solvers of other libraries
  std::uint64_t seed = 1;
};

/// Result of Model::benchmark().
struct Benchmark {
  std::vector<BenchmarkRow> rows;
  std::vector<LeftOut> left_out;
  int reference_digits = 0;  // correct digits of the reference solution's final state
  std::string advice;        // which solver to choose
  bool conclusive = false;   // a solver finished, and the reference solution is accurate enough
};

/// Options of Model::stress_test().
struct StressOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> t_end = {};
  std::vector<std::string> solvers = {};  // empty: all
  double max_seconds = 60;                // time limit of a run, s
  std::size_t max_steps = 20000;          // step limit of a run
  bool quick = false;                     // few variations of each kind
  std::uint64_t seed = 1;
};

/// Result of one solver on one variation. Verdicts: "pass" (the error is within 100 tolerances), "reported" (the error
/// is larger and was reported), "undetected" (the error is larger and undetected).
struct StressRow {
  std::string test, solver, verdict;
  double error = 0, estimate = 0;
  std::string outcome, note;
};

/// Result of Model::stress_test().
struct StressTest {
  std::vector<StressRow> rows;
  std::vector<LeftOut> left_out;
  std::size_t pass = 0, reported = 0, undetected = 0;  // rows of each verdict
};

}  // namespace eomgen
