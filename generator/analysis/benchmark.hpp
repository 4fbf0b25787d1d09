// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmark of a scene: error against run time of every eligible solver and of solvers of other libraries. Errors are
// measured against a reference solution in multiple precision.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "bench/bench.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct BenchmarkRequest : pipeline::SceneRequest {
  pipeline::ApproachChoice approach = pipeline::ApproachChoice::automatic;
  pipeline::FormChoice form = std::nullopt;
  std::vector<std::string> solvers;  // empty: all eligible solvers
  double max_seconds = 10;           // time limit of a run, s
  bool other_libraries = true;       // also measure solvers of other libraries
  std::function<void(const std::string& what)> progress;
  const std::atomic<bool>* interrupt = nullptr;
};

struct Benchmark {
  pipeline::Simulation simulation;
  reference::Solution reference;
  std::vector<std::string> states;  // names of the states that the errors of rows refer to
  std::vector<bench::Row> rows;
  std::vector<std::pair<std::string, std::string>> left_out;  // solver, why
  double reference_seconds = 0;

  /// Whether a solver finished and the reference solution is accurate enough.
  bool conclusive() const;
};

/// Throws Error{stage "bench"} for contacts, time-dependent inputs, kinks, an unknown solver, and a run that does not
/// reach its end time.
Benchmark benchmark(const BenchmarkRequest& request);

}  // namespace eomgen::analysis
