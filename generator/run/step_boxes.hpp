// SPDX-License-Identifier: GPL-3.0-or-later
// What variables are at places of one step, and between three of them. In: a system's states, inputs and parameters; a
// step with its dense output. Out: numbers and boxes for RangeCode.
#pragma once

#include <eom/run_types.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "run/range_code.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

/// From 0 to 1 in the step: time, states, inputs.
struct StepPlace {
  double s = 0;
  std::vector<double> variables;
};

class StepBoxes {
 public:
  using Inputs = std::function<const double*(double t)>;  // u at a time

  StepBoxes() = default;
  StepBoxes(const system::EquationSystem& system, const std::vector<double>& parameters);

  /// Nothing where the expression has accelerations or multipliers in it.
  std::optional<RangeCode> code(symbolic::Ref expression);

  void place(const eom::StepView& step, const Inputs& inputs, StepPlace& place) const;
  /// Between a and b, with m midway: the control points of the parabola through the three, and some more.
  const std::vector<Sloped>& box(const StepPlace& a, const StepPlace& m, const StepPlace& b) const;

  std::size_t states() const { return states_; }

 private:
  const system::EquationSystem* system_ = nullptr;
  std::vector<double> parameters_;
  std::size_t states_ = 0, inputs_ = 0;
  mutable std::vector<double> x_;
  mutable std::vector<Sloped> box_;
};

}  // namespace eomgen::run
