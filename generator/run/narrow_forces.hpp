// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that are narrow in the state: a barrier exp(-(x/w)^2) far below a step lies between the places at which the
// step sees the equations, and its tails are below any tolerance. In: the functions of a system without tails, a step
// with its dense output, the right-hand side. Out: a shorter step, where bounds of such a function leave room for
// values that no sample has, and the path of the step does not satisfy the equations at one.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "run/step_boxes.hpp"

namespace eomgen::run {

class NarrowForces {
 public:
  using Setting = eom::hybrid::Sampling;  // what a run asks with

  NarrowForces() = default;
  NarrowForces(const system::EquationSystem& system, const std::vector<double>& parameters);

  bool any() const { return !codes_.empty(); }
  /// The longest step that may be taken in its place; infinity where it may be taken as it is.
  double longest(const eom::StepView& step, const Setting& setting) const;
  /// The first step for which the bounds were too wide to tell; since the last call.
  std::optional<double> unsure() const { return std::exchange(unsure_, std::nullopt); }

 private:
  std::optional<double> hidden(const RangeCode& code, const eom::StepView& step, const Setting& setting) const;
  bool unsatisfied(const eom::StepView& step, const Setting& setting, double s, double width) const;

  std::size_t n_ = 0;
  StepBoxes boxes_;
  std::vector<RangeCode> codes_;
  mutable std::optional<double> unsure_;
  mutable std::vector<double> x_, before_, after_, dx_;
};

}  // namespace eomgen::run
