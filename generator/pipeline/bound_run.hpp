// SPDX-License-Identifier: GPL-3.0-or-later
// A run of compiled code, bound to the numbers of a scene: it can be integrated without the model. In: a compilation, a
// scene. Out: its result.
#pragma once

#include "pipeline/simulate.hpp"

namespace eomgen::pipeline {

/// Refers to the derived model and the compilation. The integration leaves both unchanged, except through the functions
/// `holds_beyond_range` and `code_for_charts` of its request.
class BoundRun {
 public:
  BoundRun(const DerivedModel& derived, const Compilation& compilation, run::Scene scene, bool estimate);
  BoundRun(const BoundRun&) = delete;
  BoundRun& operator=(const BoundRun&) = delete;

  const run::Scene& scene() const { return scene_; }
  const run::Code& code() const { return code_; }
  run::RunRequest& request() { return request_; }
  run::RunResult integrate() const { return run::integrate_scene(request_); }

 private:
  run::Scene scene_;
  run::Code code_;
  run::RunRequest request_;
};

}  // namespace eomgen::pipeline
