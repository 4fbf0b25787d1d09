// SPDX-License-Identifier: MIT
// Adaptive steps in place of fixed ones while slip in two directions is so slow that fixed steps resolve neither its
// direction nor its end. In: the state at the end of a step. Out: whether the kind of steps changes there.
#pragma once

#include <algorithm>
#include <cmath>

#include "eom/hybrid/parts.hpp"

namespace eom::hybrid {

class SlowSlip {
 public:
  explicit SlowSlip(Parts& parts) : parts_(parts) {}

  /// Starts a run; fixed_step: 0 if steps are adaptive anyway.
  void start(double fixed_step) {
    fixed_step_ = fixed_step;
    finer_ = due_ = false;
    choice_ = {};
  }

  bool changes_at(double t, const double* x) {
    return fixed_step_ > 0 && parts_.contacts && parts_.contacts->slow_slip(t, x, fixed_step_, finer_) != finer_;
  }
  void change() { finer_ = !finer_; }
  bool finer() const { return finer_; }

  /// Whether a change is pending at the end of the step.
  bool due() const { return due_; }
  void due(bool due) { due_ = due; }

  Options finer(const Options& asked) {
    Options options = asked;
    options.fixed_step = options.initial_step = 0;
    options.max_step = asked.fixed_step;
    // Tighter in a repeated run, in proportion to its shorter steps, so that the estimate includes the error of these
    // steps.
    const double part = std::min(1.0, asked.fixed_step / parts_.problem.step);
    options.rtol = slow_slip_rtol * std::max(0.01, std::pow(part, 4));
    options.atol = slow_slip_atol;
    options.choice = &choice_;
    return options;
  }

 private:
  Parts& parts_;
  double fixed_step_ = 0;  // of the run
  bool finer_ = false, due_ = false;
  Choice choice_;
};

}  // namespace eom::hybrid
