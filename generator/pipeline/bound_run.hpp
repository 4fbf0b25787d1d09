// SPDX-License-Identifier: GPL-3.0-or-later
// The one way from compiled code to an integration. In: a compilation, and a scene in numbers. Out: the request of its
// run, and the result. Commands, eomgen::CompiledModel and eomgen::Simulation make their runs here.
#pragma once

#include "pipeline/simulate.hpp"

namespace eomgen::pipeline {

/// The request of a run without rows. It refers to the arguments. The integration leaves them unchanged, except through
/// the functions `holds_beyond_range` and `code_for_charts` of the request.
run::RunRequest make_run_request(const DerivedModel& derived, const Compilation& compilation, const run::Scene& scene,
                                 bool estimate);

/// A run bound to the numbers of its scene: it can be integrated without the model.
class BoundRun {
 public:
  BoundRun(const DerivedModel& derived, const Compilation& compilation, run::Scene scene, bool estimate);
  BoundRun(const BoundRun&) = delete;
  BoundRun& operator=(const BoundRun&) = delete;

  const run::Scene& scene() const { return scene_; }
  const run::Code& code() const { return request_.code; }
  run::RunRequest& request() { return request_; }
  run::RunResult integrate() const;
  /// Integrates, and adds the reasons of the plan to the result.
  run::RunResult integrate(const RunPlan& plan, const RunControl& control);
  /// The problem of the runtime, which refers to this run. `solver`: an eligible one.
  eom::hybrid::Problem problem(const std::string& solver) const;

 private:
  run::Scene scene_;
  run::RunRequest request_;
};

}  // namespace eomgen::pipeline
