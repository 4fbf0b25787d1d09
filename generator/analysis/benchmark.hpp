// SPDX-License-Identifier: GPL-3.0-or-later
// Error against run time of a scene: every solver that fits it, and those of other libraries, against the reference.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "bench/bench.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct BenchmarkRequest {
  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;  // parameters and the end
  pipeline::ApproachChoice approach = pipeline::ApproachChoice::automatic;
  pipeline::FormChoice form = std::nullopt;
  std::vector<std::string> solvers;  // empty: all that fit
  double seconds = 10;               // what takes longer is interrupted
  bool libraries = true;             // those of other libraries too
  std::uint64_t seed = 1;
  std::function<void(const std::string& what)> progress;
  const std::atomic<bool>* interrupt = nullptr;
};

struct Benchmark {
  pipeline::Simulation simulation;
  reference::Solution reference;
  std::vector<std::string> states;  // names of what the rows have errors of
  std::vector<bench::Row> rows;
  std::vector<std::pair<std::string, std::string>> left_out;  // solver, why
  double seconds_reference = 0;

  /// Whether a solver came to the end, and the reference has digits enough to be one.
  bool conclusive() const;
};

/// Throws Error{stage "bench"}: contacts, inputs that move, kinks, an unknown solver, a run that does not come to its
/// end.
Benchmark benchmark(const BenchmarkRequest& request);

}  // namespace eomgen::analysis
