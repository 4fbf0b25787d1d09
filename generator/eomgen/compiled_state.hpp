// SPDX-License-Identifier: GPL-3.0-or-later
// The data of a CompiledModel. Not installed.
#pragma once

#include <string>
#include <vector>

#include "eomgen/compiled_model.hpp"
#include "eomgen/prepared_runs.hpp"
#include "eomgen/rhs_lanes.hpp"

namespace eomgen {

/// The shared data of a CompiledModel and its copies.
struct CompiledModel::State {
  /// To be called under the lock.
  State(PreparedRun from, std::shared_ptr<PreparedRuns> cache);

  /// The functions of the C ABI (docs/abi.md).
  const abi::CompiledFunctions& functions() const { return run.compilation->code.functions(); }
  /// The scene with its numbers.
  const run::Scene& scene() const { return run.plan->scene; }
  /// The functions in the form that a run needs.
  const run::Code& code() const { return bound->code(); }

  std::shared_ptr<PreparedRuns> runs;
  PreparedRun run;
  std::shared_ptr<pipeline::BoundRun> bound;
  std::vector<Quantity> states, parameters, inputs, outputs;
  std::vector<std::string> constraints, reactions, events, frames, inertial_parameters;
  SceneValues values;
  std::string certificate, tier;
  std::vector<double> constant_inputs;  // empty if some input varies
  std::vector<double> prepared;         // of the scene's parameters
  bool is_prepared = false;             // `prepared` is valid
  RhsLanes lanes;
};

}  // namespace eomgen
