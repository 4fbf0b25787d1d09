// SPDX-License-Identifier: GPL-3.0-or-later
// Error against run time, and behaviour under stress.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

struct BenchmarkOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> t_end = {};
  std::vector<std::string> solvers = {};  // empty: all that fit
  double seconds = 10;                    // what takes longer is interrupted
  bool libraries = false;                 // those of other libraries too
  std::uint64_t seed = 1;
};

struct BenchmarkRow {
  std::string solver;
  double rtol = 0, step = 0;  // one of them is 0
  double error = 0;           // of the end state, relative to the largest value of each component
  double seconds = 0;         // median
  std::size_t steps = 0, rhs_evaluations = 0;
  std::string outcome;
};

struct Benchmark {
  std::vector<BenchmarkRow> rows;
  std::vector<LeftOut> left_out;
  int reference_digits = 0;  // of the end state
  std::string advice;
  bool conclusive = false;
};

struct StressOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> t_end = {};
  std::vector<std::string> solvers = {};  // empty: all
  double seconds = 60;
  std::size_t steps = 20000;
  bool quick = false;
  std::uint64_t seed = 1;
};

struct StressRow {
  std::string test, solver, verdict;  // "kept", "told", "silent"
  double error = 0, estimate = 0;
  std::string outcome, note;
};

struct StressTest {
  std::vector<StressRow> rows;
  std::vector<LeftOut> left_out;
  std::size_t kept = 0, told = 0, silent = 0;
};

}  // namespace eomgen
