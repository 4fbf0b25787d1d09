// SPDX-License-Identifier: MIT
// Adaptive steps in place of fixed ones while slip in two directions is so slow that fixed steps resolve neither its
// direction nor its end. In: the state at the end of a step. Out: whether the kind of steps changes there.
#pragma once

#include <algorithm>
#include <cmath>

#include "eom/hybrid/run_context.hpp"

namespace eom::hybrid {

class SlowSlipSteps {
 public:
  explicit SlowSlipSteps(RunContext& context) : context_(context) {}

  /// Starts a run; fixed_step: 0 if steps are adaptive anyway.
  void start(double fixed_step) {
    fixed_step_ = fixed_step;
    is_active_ = due_ = false;
    choice_ = {};
  }

  bool must_switch(double t, const double* x) {
    return fixed_step_ > 0 && context_.contacts &&
           context_.contacts->is_slip_slow(t, x, fixed_step_, is_active_) != is_active_;
  }
  void toggle() { is_active_ = !is_active_; }
  bool is_active() const { return is_active_; }

  /// Whether a change is pending at the end of the step.
  bool is_switch_due() const { return due_; }
  void set_switch_due(bool due) { due_ = due; }

  Options refined_options(const Options& asked) {
    Options options = asked;
    options.fixed_step = options.initial_step = 0;
    options.max_step = asked.fixed_step;
    // Tighter in a repeated run, in proportion to its shorter steps, so that the estimate includes the error of these
    // steps.
    const double part = std::min(1.0, asked.fixed_step / context_.problem.fixed_step);
    options.rtol = slow_slip_rtol * std::max(0.01, std::pow(part, 4));
    options.atol = slow_slip_atol;
    options.choice = &choice_;
    return options;
  }

 private:
  RunContext& context_;
  double fixed_step_ = 0;  // of the run
  bool is_active_ = false, due_ = false;
  MethodChoice choice_;
};

}  // namespace eom::hybrid
