// SPDX-License-Identifier: GPL-3.0-or-later
// Many runs of a scene by threads, in which explicit Runge-Kutta methods, rodas and taylor take some side by side in
// the lanes of vector registers (eom/ensemble), and other methods one after the other. In: a run that has been made,
// values for the others. Out: their results, to the last bit those that they have alone.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emit/shared_library/loaded_batch.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::pipeline {

struct EnsembleRuns {
  std::vector<std::size_t> runs;
  std::size_t threads = 1;
  std::function<run::Overrides(std::size_t run)> values;
  /// Called by one thread at a time, in no particular order; not for runs that an interruption ended.
  std::function<void(std::size_t run, const run::RunResult& result)> done;
  std::function<void(std::size_t run, const std::string& why)> refused;  // could not begin
  const std::atomic<bool>* interrupt = nullptr;
};

/// Where nothing is said an ensemble is integrated by this: no method that could change on the way.
std::string ensemble_solver(const model::Scene& scene, const run::Overrides& overrides);

/// Why the runs of this scene cannot be made side by side; empty where they can. Only a run alone looks after contacts,
/// kinks, constraints with multipliers, charts that are exchanged, ranges, inputs that move, integrals and narrow
/// forces.
std::string ensemble_obstacle(const Simulation& first);

/// The code of a scene for many states, compiled once.
class Ensemble {
 public:
  /// `first` has to live as long.
  explicit Ensemble(const Simulation& first);
  /// Runs that do not end as planned, and those in which time alone does something, are made once more alone.
  void run(const EnsembleRuns& asked);

 private:
  const Simulation& first_;
  std::optional<emit::LoadedBatch> batch_;
};

}  // namespace eomgen::pipeline
