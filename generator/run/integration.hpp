// SPDX-License-Identifier: GPL-3.0-or-later
// One integration of a scene, restarted at the jumps of its inputs; `run` makes one for the result and others for the
// error estimate.
#pragma once

#include <eom/constraints/projection.hpp>

#include "run/constraint_rows.hpp"

namespace eomgen::run {

class Integration {
 public:
  explicit Integration(const RunRequest& request, std::string solver);

  /// observer(step, u_side): called after each accepted step; may be empty.
  using Observer = std::function<bool(const eom::StepView&)>;
  eom::Result run(const eom::Options& options, const Observer& observer);

  std::vector<double> initial_state() const;
  int outputs(double t, const double* x, std::span<double> y) const;
  /// Largest |psi|, |f . qdot + b| of a state; 0 without active constraints.
  double constraint_defect(double t, const double* x) { return rows_.defect(t, x); }

  double position_correction = 0, velocity_correction = 0, work = 0;  // of projections, summed or largest

 private:
  int rhs(double t, const double* x, double* dx);
  int project(double t, double* x);
  const double* inputs(double t) const;

  const RunRequest& request_;
  const Code& code_;
  std::string solver_;
  std::size_t n_;
  std::size_t power_ = 0, energy_ = 0;
  double side_ = 0;  // a time inside the piece of the inputs that is being integrated
  mutable std::vector<double> u_;
  std::vector<double> w_;  // of code_.prepare
  std::vector<double> y_;
  ConstraintRows rows_;
  eom::Projection projection_;
};

}  // namespace eomgen::run
