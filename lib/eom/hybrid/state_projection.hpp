// SPDX-License-Identifier: MIT
// States put back onto their constraints at the end of steps, and what that does. In: rows of the constraints, M. Out:
// the state that is nearest in the metric of M, the largest corrections, the work of the projections of accepted steps.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/constraints/projection.hpp"
#include "eom/hybrid/constraint_rows.hpp"
#include "eom/hybrid/model.hpp"
#include "eom/hybrid/outputs.hpp"

namespace eom::hybrid {

class StateProjection {
 public:
  StateProjection(const Problem& problem, Model& model, ConstraintRows& rows, Outputs& outputs)
      : model_(model), rows_(rows), outputs_(outputs), projection_(problem.n(), rows.size(), rows.on_positions()) {}

  /// The code of a callback, or of a projection that does not converge; the state is as it was then.
  int operator()(double t, double* x) {
    const double before = outputs_.energy(t, x);
    const ProjectionResult moved = projection_(
        t, x,
        [&](double at, const double* state, double* psi, double* A, double* b) {
          return rows_(at, state, model_.inputs(at), psi, A, b);
        },
        [&](double at, const double* state, double* M, double*) { return model_.mass(at, state, M); });
    if (moved.code != 0) return moved.code;
    const double after = outputs_.energy(t, x);
    largest_.position = std::max(largest_.position, moved.position_correction);
    largest_.velocity = std::max(largest_.velocity, moved.velocity_correction);
    trials_.emplace_back(t, after - before);
    return 0;
  }

  /// Of an accepted step: the work of its projection; others were made on trial.
  void accept(const StepView& step) {
    const auto made = std::find_if(trials_.rbegin(), trials_.rend(), [&](const auto& p) { return p.first == step.t1; });
    if (made != trials_.rend()) work_ += made->second;
    trials_.clear();
  }

  /// Largest corrections of one component.
  struct Corrections {
    double position = 0, velocity = 0;
  };
  const Corrections& largest() const { return largest_; }
  double work() const { return work_; }
  /// A run begins; or only the start was moved.
  void forget() { largest_ = {}, work_ = 0, trials_.clear(); }
  /// What was moved since `before` were no steps of the run.
  void undo(const Corrections& before) { largest_ = before, trials_.clear(); }

 private:
  Model& model_;
  ConstraintRows& rows_;
  Outputs& outputs_;
  Projection projection_;
  Corrections largest_;
  double work_ = 0;
  std::vector<std::pair<double, double>> trials_;  // time, work since the last accepted step
};

}  // namespace eom::hybrid
