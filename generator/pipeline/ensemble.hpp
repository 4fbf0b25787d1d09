// SPDX-License-Identifier: GPL-3.0-or-later
// Many runs of a scene in threads. Explicit Runge-Kutta methods, rodas and taylor integrate several runs side by side
// in the lanes of vector registers (eom/ensemble), other methods one after the other. In: a finished run, and the
// values of the others. Out: their results, bit for bit those of separate runs.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emit/shared_library/loaded_batch.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::pipeline {

struct EnsembleRequest {
  std::vector<std::size_t> runs;
  std::size_t threads = 1;
  std::function<run::Overrides(std::size_t run)> overrides;
  /// Called by one thread at a time, in no particular order; not for runs that an interruption ended.
  std::function<void(std::size_t run, const run::RunResult& result)> on_end;
  std::function<void(std::size_t run, const std::string& why)> on_refusal;  // called for a run without a valid start
  const std::atomic<bool>* interrupt = nullptr;
};

/// The default solver of an ensemble: a method that does not change during the run.
std::string ensemble_solver(const model::Scene& scene, const run::Overrides& overrides);

/// The reason why the runs of this scene cannot be made side by side; empty if they can. Only separate runs handle
/// contacts, kinks, constraints with multipliers, changes of charts, ranges, varying inputs, integrals and narrow
/// forces.
std::string ensemble_obstacle(const Simulation& first);

/// The code of a scene for many states, compiled once.
class Ensemble {
 public:
  /// `first` has to outlive the ensemble.
  explicit Ensemble(const Simulation& first);
  /// Runs that end early, and runs with events in time alone, are repeated as separate runs.
  void run(const EnsembleRequest& asked);

 private:
  const Simulation& first_;
  std::optional<emit::LoadedBatch> batch_;
};

}  // namespace eomgen::pipeline
