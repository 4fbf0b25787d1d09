// SPDX-License-Identifier: MIT
// Projection of states onto their constraints at the end of steps, with its statistics. In: rows of the constraints, M.
// Out: the nearest state in the metric of M, the largest corrections, the work of the projections of accepted steps.
#pragma once

#include <algorithm>
#include <array>
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
      : model_(model),
        rows_(rows),
        outputs_(outputs),
        n_(problem.n()),
        shape_{rows.size(), rows.position_row_count()},
        projection_(n_, shape_[0], shape_[1]) {}

  /// Returns the code of a callback or of a projection that does not converge. In both cases the state is unchanged.
  int operator()(double t, double* x) {
    const std::array<std::size_t, 2> shape{rows_.size(), rows_.position_row_count()};
    if (shape != shape_) projection_ = Projection(n_, shape[0], shape[1]);  // contacts opened, closed, stuck or slipped
    shape_ = shape;
    if (rows_.changes() != changes_) projection_.reset();
    changes_ = rows_.changes();
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

  /// Adds the work of the projection of an accepted step and discards those of trial steps.
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
  /// Called at the start of a run, and after the projection of the start.
  void reset() { largest_ = {}, work_ = 0, trials_.clear(); }
  /// Restores the corrections `before`: later projections did not belong to steps of the run.
  void restore_corrections(const Corrections& before) { largest_ = before, trials_.clear(); }

 private:
  Model& model_;
  ConstraintRows& rows_;
  Outputs& outputs_;
  std::size_t n_;
  std::array<std::size_t, 2> shape_;  // rows of the projection, and those of positions
  std::size_t changes_ = 0;           // of the contacts to which the projection belongs
  Projection projection_;
  Corrections largest_;
  double work_ = 0;
  std::vector<std::pair<double, double>> trials_;  // time, work since the last accepted step
};

}  // namespace eom::hybrid
