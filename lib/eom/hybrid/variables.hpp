// SPDX-License-Identifier: MIT
// Values of the variables of a run's expressions: t, free coordinates, their rates, states of first order, inputs.
// In: points of one step. Out: values at a point, and boxes that contain the path between three points.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "eom/expressions/code.hpp"
#include "eom/hybrid/problem.hpp"

namespace eom::hybrid {

/// s: position in the step, from 0 to 1.
struct StepPlace {
  double s = 0;
  std::vector<double> variables;
};

class StepVariables {
 public:
  /// states: components without the work that a run integrates.
  StepVariables(std::size_t states, std::size_t inputs) : states_(states), inputs_(inputs) {}

  /// Leaves out all variables but the first `count`.
  void limit(std::size_t count) {
    inputs_ = count > 1 + states_ ? std::min(inputs_, count - 1 - states_) : 0;
    states_ = std::min(states_, count - 1);
  }

  void at(const StepView& step, const Sampling& sampling, StepPlace& place) const {
    const double t = place.s >= 1 ? step.t1 : step.t0 + place.s * (step.t1 - step.t0);
    x_.resize(step.x0.size());
    if (place.s <= 0)
      x_.assign(step.x0.begin(), step.x0.end());
    else if (place.s >= 1)
      x_.assign(step.x1.begin(), step.x1.end());
    else
      step.interpolate(t, x_);
    place.variables.assign(1, t);
    place.variables.insert(place.variables.end(), x_.begin(), x_.begin() + static_cast<std::ptrdiff_t>(states_));
    if (inputs_ == 0) return;
    const double* u = sampling.inputs(t);
    place.variables.insert(place.variables.end(), u, u + inputs_);
  }

  /// Box between a and b, with m midway: the control points of the parabola through the three, with a margin. The
  /// margin falls faster than the width of the box: of variables with nearly the same motion, such as the places of two
  /// bodies that move together, a difference has to be bounded.
  const std::vector<expressions::SlopedInterval>& box(const StepPlace& a, const StepPlace& m,
                                                      const StepPlace& b) const {
    constexpr double share = 0.05, narrow = 0.25;                       // of the width of a box; of the step
    const double beyond = share * std::min(1.0, (b.s - a.s) / narrow);  // terms beyond second order within a box
    box_.resize(a.variables.size());
    for (std::size_t v = 0; v < box_.size(); ++v) {
      const double x = a.variables[v], z = b.variables[v], control = 2 * m.variables[v] - (x + z) / 2;
      const double bend = beyond * std::max(std::abs(control - x), std::abs(z - control)),
                   low = std::min(2 * (control - x), 2 * (z - control)),
                   high = std::max(2 * (control - x), 2 * (z - control));
      const double loose = v == 0 ? 0 : 4 * bend;
      box_[v] = {{std::min({x, z, control}) - bend, std::max({x, z, control}) + bend}, {low - loose, high + loose}};
    }
    return box_;
  }

 private:
  std::size_t states_, inputs_;
  mutable std::vector<double> x_;
  mutable std::vector<expressions::SlopedInterval> box_;
};

/// The variables of a model's expressions at points of its steps.
inline StepVariables step_variables(const Problem& problem) {
  return {problem.code->layout().size(), problem.inputs.size()};
}

}  // namespace eom::hybrid
