// SPDX-License-Identifier: GPL-3.0-or-later
// What time alone does in a scene: functions of t, also through inputs, cost nothing to look at, and a pulse among them
// is shorter than the steps that the motion before it allows. In: a system, numbers for its parameters and inputs, a
// span of time. Out: times at which a kink of such a function is crossed, and bounds of steps that follow the smooth
// ones.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <eom/run_types.hpp>
#include <string>
#include <vector>

#include "run/signal.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

using eom::hybrid::Break;

struct Clock {
  std::vector<Break> breaks;                   // inside the span, ascending; without the jumps of tables
  std::vector<eom::StepBound> bounds;          // none: nothing is narrow beside the span
  std::optional<double> unfollowed_from = {};  // a condition on time changes too often to be followed from there on
};

/// An input of the scene: what it is as an expression, where it is one.
struct ClockInput {
  const Signal* signal = nullptr;
  std::optional<symbolic::Ref> expression;  // none: a table
};

Clock look_at_time(const system::EquationSystem& system, const std::vector<double>& parameters,
                   const std::vector<ClockInput>& inputs, double t0, double t1);

}  // namespace eomgen::run
