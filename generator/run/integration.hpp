// SPDX-License-Identifier: GPL-3.0-or-later
// One integration of a request, for whoever looks at its steps: eom::hybrid::Integration, bound to a scene.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <eom/hybrid/run_result.hpp>
#include <memory>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

class Integration {
 public:
  /// The request has to stay. `solver`: one that can integrate it.
  Integration(const RunRequest& request, const std::string& solver);
  ~Integration();
  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  /// observer: called after each accepted step; may be empty. May be called again.
  eom::Result run(const eom::Options& options, const eom::hybrid::Observer& observer);

  /// Of a start near where a chart fails: in the second one.
  const std::vector<double>& initial_state() const;
  /// Of contacts, where the run is.
  int contact_mode() const;
  /// Of the last run, per kink.
  const std::vector<std::size_t>& kink_crossings() const;
  /// Largest |psi|, |f . qdot + b| of a state; 0 without active constraints.
  double constraint_defect(double t, const double* x);
  /// dx/dt in the mode of the start; a code.
  int derivative(double t, const double* x, double* dx);

 private:
  struct Bound;
  std::unique_ptr<Bound> bound_;
};

/// eom::hybrid::run, compiled once.
eom::hybrid::RunResult run_problem(const eom::hybrid::Problem& problem);

}  // namespace eomgen::run
