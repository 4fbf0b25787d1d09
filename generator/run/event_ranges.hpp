// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of event functions along a step: a bump that is narrower than the distances between the places at which a step
// is sampled changes the sign of none of them. In: functions of the state as expressions, a step with its dense output.
// Out: the first place where one has crossed zero, unless its bounds show that it nowhere does.
#pragma once

#include <optional>
#include <utility>

#include "run/step_boxes.hpp"

namespace eomgen::run {

class EventRanges {
 public:
  EventRanges() = default;
  /// functions: by their place among the event functions; nothing where it cannot be bounded.
  EventRanges(const system::EquationSystem& system, const std::vector<std::optional<symbolic::Ref>>& functions,
              const std::vector<double>& parameters);

  bool any() const { return any_; }
  /// Between which places of the step (from 0 to 1) function i first leaves its side.
  std::optional<std::pair<double, double>> first(const eom::StepView& step, std::size_t i, int side, double from,
                                                 double to, const StepBoxes::Inputs& inputs) const;

 private:
  StepBoxes boxes_;
  bool any_ = false;
  std::vector<std::optional<RangeCode>> codes_;
};

}  // namespace eomgen::run
