// SPDX-License-Identifier: MIT
// Steps that are chosen in place of fixed ones, where slip in two directions is so slow that fixed ones follow neither
// its direction nor its end. In: the state at the end of a step. Out: whether the steps are to be others from there on.
#pragma once

#include <algorithm>
#include <cmath>

#include "eom/hybrid/parts.hpp"

namespace eom::hybrid {

class SlowSlip {
 public:
  explicit SlowSlip(Parts& parts) : parts_(parts) {}

  /// A run begins; fixed_step: 0 where steps are chosen anyway.
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

  /// Whether a change is to be made at the end of the step.
  bool due() const { return due_; }
  void due(bool due) { due_ = due; }

  Options finer(const Options& asked) {
    Options options = asked;
    options.fixed_step = options.initial_step = 0;
    options.max_step = asked.fixed_step;
    // Tighter in a further run, as its steps are shorter, so that the estimate sees the error of these steps too.
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
