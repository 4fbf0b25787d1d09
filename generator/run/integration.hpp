// SPDX-License-Identifier: GPL-3.0-or-later
// One integration of a request, with access to its steps: eom::hybrid::Integration, bound to a scene.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <eom/hybrid/run_result.hpp>
#include <eom/hybrid/segments.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

class Integration {
 public:
  /// `request` has to outlive the integration. `solver`: an eligible one.
  Integration(const RunRequest& request, const std::string& solver);
  ~Integration();
  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  /// observer: called after each accepted step; event: for each event. Both may be empty. `run` may be called again.
  eom::Result run(const eom::Options& options, const eom::hybrid::Observer& observer,
                  const eom::hybrid::OnEvent& event = {});

  /// The initial state; in the second chart if the start is near a singularity of a chart.
  const std::vector<double>& initial_state() const;
  /// The time at which it begins: t0, or behind a kink there.
  double begin() const;
  /// The argument `mode` of the code for the current states of the contacts. Branches of kinks follow the state.
  std::vector<int> contact_mode() const;
  /// Number of crossings of kinks in the last run, without kinks in time.
  std::size_t kink_crossings() const;
  /// The segments of the run between jumps of inputs and kinks in time.
  std::vector<eom::hybrid::Segment> segments() const;
  /// Largest |psi| or |f . qdot + b| of a state; 0 without active constraints.
  double constraint_defect(double t, const double* x);
  /// dx/dt in the contact mode of the start; returns an error code.
  int derivative(double t, const double* x, double* dx);

 private:
  struct Bound;
  std::unique_ptr<Bound> bound_;
};

/// Integrates the scene. Throws Error{stage "run"} for a solver that does not exist or needs a step.
RunResult integrate_scene(const RunRequest& request);

}  // namespace eomgen::run
